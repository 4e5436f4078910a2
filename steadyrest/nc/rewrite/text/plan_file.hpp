// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <cstddef>
#include <string>
#include <string_view>
#include <vector>

#include <steadyrest/kernel/outcome/result.hpp>

/// Writes corrections into the text of an NC program, takes them out again, and proves them.
namespace steadyrest::nc::rewrite {

/// From `time_s` on, the axis is corrected for `displacement_um` in total.
struct PlannedStep {
  double time_s = 0.0;           ///< since the program's start
  double displacement_um = 0.0;  ///< Σ δ so far; the axis is moved by its negative
};

struct AxisPlan {
  char letter = 'Z';
  std::size_t index = 2;           ///< in interpret::Axes
  std::vector<PlannedStep> steps;  ///< in the order of time; only where the sum changes
};

/// The system R of corrections: {n; {t_j}; {δ_j}} for each transition, n the number of intervals,
/// t_j their durations, δ_j the additional displacement to correct at the START of interval j. The
/// sum carries over from transition to transition.
struct Plan {
  std::string file;
  std::string machine;  ///< machine file named in the plan; empty for none
  double total_s = 0.0;
  std::vector<AxisPlan> axes;
};

/// Whether there is anything to correct.
[[nodiscard]] inline bool corrects(const Plan& plan) noexcept {
  return std::ranges::any_of(plan.axes, [](const AxisPlan& axis) { return !axis.steps.empty(); });
}

/// Reads PLAN.json (README.md has its keys). Refused with the line or the key: invalid JSON,
/// unknown keys, a key twice, lists whose length is not n, numbers out of range.
[[nodiscard]] kernel::outcome::Result<Plan> read_plan(const std::string& path);
/// The text alone, for whoever also reads the plan maker's own remarks; one byte more than allowed
/// of a file that is too large. Refused: a file that cannot be read.
[[nodiscard]] kernel::outcome::Result<std::string> read_plan_text(const std::string& path);
[[nodiscard]] kernel::outcome::Result<Plan> parse_plan(std::string_view text,
                                                       const std::string& path);

}  // namespace steadyrest::nc::rewrite
