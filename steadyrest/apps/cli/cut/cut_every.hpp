// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <vector>

#include <steadyrest/apps/cli/cut/cut_corrected.hpp>
#include <steadyrest/apps/cli/cut/cut_runs.hpp>
#include <steadyrest/trial/cut/report_data.hpp>

/// Settings of the control and corrected texts, cut beside what the layer can do.
namespace steadyrest::apps::cli::cut {

/// Runs that cut_every() makes at most.
inline constexpr std::size_t kMostEvery = 5;

struct EveryWay {
  trial::cut::BestWays best;
  trial::cut::Run best_run;  ///< of the best way in the same time
  std::vector<trial::cut::OverLimitLine> over_limit;
  std::vector<std::string> not_possible;  ///< which way, and why
};

/// A program so long is not worked out unless that is asked for.
[[nodiscard]] bool is_long(const nc::plan::PlannedPath& path, const trial::cut::Figures& now);

/// Cuts what can be had beyond the layer and adds it to `ways`, which hold the program as it is and
/// the layer; then takes the best. `with`: the cut by the layer.
[[nodiscard]] Result<EveryWay> cut_every(const Setup& setup, const CorrectTask& task,
                                         const PathPointer& path, const trial::cut::Recorder& with,
                                         CutRuns& runs, std::vector<trial::cut::WayFigures>& ways,
                                         Progress& progress);

}  // namespace steadyrest::apps::cli::cut
