// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <vector>

#include <steadyrest/apps/cli/program/ahead/path_ahead.hpp>
#include <steadyrest/contour/offline/causes/causes.hpp>
#include <steadyrest/contour/offline/settings/settings.hpp>

/// The best text that path and feeds give, what it leaves and why.
namespace steadyrest::apps::cli {

struct CorrectedPath {
  contour::offline::Predistorted done;
  std::string by =
      "path";  ///< what holds the limit best: path, feeds, or path and feeds by stretch
  std::vector<contour::offline::OverLine> over;
  std::vector<contour::offline::Setting> settings;  ///< the best first
  std::string unexplained;  ///< why causes and settings are not known; empty: they are
};

/// As path_ahead(). Where the limit is to be held, lower feeds on the programmed path and, for each
/// stretch between two rapids, the better of both are tried too, and taken where they keep the
/// limit, or leave less over it in no more time.
[[nodiscard]] Result<CorrectedPath> corrected_path(const PathOptions& options,
                                                   const SourceProgram& program,
                                                   const std::string& file,
                                                   const std::vector<nc::rewrite::Told>& told,
                                                   Progress& progress);

/// put_path(), and the keys `by`, `settings[]` and of each of `remaining[]` `reason` and `cures[]`.
[[nodiscard]] std::string put_corrected(Answer& answer, const CorrectedPath& corrected,
                                        const PathOptions& options);

}  // namespace steadyrest::apps::cli
