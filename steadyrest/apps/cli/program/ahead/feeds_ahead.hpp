// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include <steadyrest/apps/cli/program/ahead/changed_program.hpp>
#include <steadyrest/contour/offline/predict/error_figures.hpp>
#include <steadyrest/nc/rewrite/replace/replace.hpp>

/// The work of `program feeds`: feeds from the servo model, their text, and the proof of it.
namespace steadyrest::apps::cli {

/// Of the largest permitted error, what is kept back.
struct FeedReserve {
  double margin_mm = 0.0;    ///< [contour] margin_percent: friction and what the model misses
  double backlash_mm = 0.0;  ///< half of the largest backlash: no encoder on a motor sees it
  double encoder_mm = 0.0;   ///< largest error of the encoders' lines
  double limit_mm = 0.0;     ///< that remains
};
[[nodiscard]] FeedReserve feed_reserve(const kernel::machine::Machine& machine,
                                       double max_error_mm) noexcept;

/// A line whose error stays above the limit.
struct OverLimit {
  std::uint32_t line = 0;
  double error_mm = 0.0;
  std::string why;
};

struct FeedsAhead : contour::offline::PredictedChange {
  nc::rewrite::NewLines lines;    ///< in place of the program's
  nc::rewrite::Replaced changed;  ///< the program itself when nothing had to change
  std::vector<OverLimit> over;    ///< in order of lines
};

/// The text is proved. Blocks for which no proof was found stay (Stays::unproved) in `program`,
/// too.
[[nodiscard]] Result<FeedsAhead> feeds_ahead(SourceProgram& program, const std::string& file,
                                             double limit_mm,
                                             const std::vector<nc::rewrite::Told>& told,
                                             Progress& progress);

}  // namespace steadyrest::apps::cli
