// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <functional>
#include <map>
#include <string>
#include <vector>

#include <steadyrest/contour/offline/predict/model_run.hpp>
#include <steadyrest/kernel/machine/machine.hpp>
#include <steadyrest/kernel/outcome/result.hpp>
#include <steadyrest/nc/plan/path/planned_path.hpp>

namespace steadyrest::contour::offline {

/// A program on the servo model, and the path that its part should have.
struct OverTask {
  const kernel::machine::Machine& machine;
  const nc::plan::PlannedPath& path;      ///< that the control runs
  const nc::plan::PlannedPath& original;  ///< that the part should have
  const PathMap& map;
  double limit_mm = 0.01;
  /// The original's line of a line of `path`.
  std::function<std::uint32_t(std::uint32_t line)> origin = [](std::uint32_t line) { return line; };
  /// Why a line of the original could not be corrected; empty: it could.
  std::function<std::string(std::uint32_t line)> kept = [](std::uint32_t) { return std::string{}; };
  /// ModelRun::unknown
  std::function<kernel::signal::Point(double foot_mm)> unknown = nullptr;
};

/// What brings the error at one place within the limit, and what it costs.
struct Cure {
  std::string what;        ///< in the program's words: "G4 P0.12 before line 12"
  double seconds = 0.0;    ///< that the program takes longer
  double leaves_mm = 0.0;  ///< the largest error there then
  [[nodiscard]] bool holds(double limit_mm) const noexcept { return leaves_mm <= limit_mm; }
};

/// A line whose predicted error is above the limit: why, and what would cure it.
struct OverLine {
  std::uint32_t line = 0;  ///< of the original
  double error_mm = 0.0;
  std::string reason;
  std::vector<Cure> cures;  ///< the cheapest that holds first; empty: none was tried
};

/// The lines above the limit, the worst first. Each cure is run on the servo model, in a window
/// from stop to stop round the place: a dwell before the line where a rapid, or before a corner,
/// the tool is still behind; a lower feed on the lines there. Cures are tried for the worst
/// `most_cured` places; lines whose errors belong to one place have the same.
[[nodiscard]] kernel::outcome::Result<std::vector<OverLine>> lines_over(const OverTask& task,
                                                                        std::size_t most_cured);

/// How one line runs: the original's, by the command.
struct LineRun {
  double seconds = 0.0;
  double error_mm = 0.0;
  double least_mm_s = 0.0;  ///< speed of the command where it cuts
};
[[nodiscard]] kernel::outcome::Result<std::map<std::uint32_t, LineRun>> line_runs(
    const OverTask& task);

/// What another text of the same program does at the lines over the limit, as a cure of this name:
/// its price is the time of the line and of its neighbours.
void add_cure(std::vector<OverLine>& over, const std::map<std::uint32_t, LineRun>& now,
              const std::map<std::uint32_t, LineRun>& other, const std::string& name,
              double limit_mm);

}  // namespace steadyrest::contour::offline
