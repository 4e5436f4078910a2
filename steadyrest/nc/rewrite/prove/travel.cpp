// SPDX-License-Identifier: Apache-2.0
#include <algorithm>

#include <fmt/core.h>

#include <steadyrest/nc/rewrite/prove/travel.hpp>

namespace steadyrest::nc::rewrite {

using interpret::Move;

// The original may exceed the travel by itself: the control deals with that. Only what the
// correction adds is judged here.
std::string over_travel(std::span<const kernel::machine::Axis> axes, char letter,
                        const Reach& original, const Reach& corrected) {
  constexpr double kRounding_mm = 1e-9;
  // Rotary axes take no corrections.
  const auto axis = std::ranges::find_if(axes, [letter](const auto& one) {
    return one.name.size() == 1 && one.name[0] == letter && !one.rotary;
  });
  if (axis == axes.end()) {
    return {};
  }
  const auto fault = [letter](double to_mm, double end_mm, double own_mm) {
    return fmt::format(
        "the correction takes {} to {:.4f} mm, past the end of its travel at {:g} mm; without it "
        "{} goes to {:.4f} mm (machine coordinates)",
        letter, to_mm, end_mm, letter, own_mm);
  };
  // Exactly at the limit is allowed; positions are sums of rounded numbers.
  if (corrected.high_mm > axis->max_au + kRounding_mm &&
      original.high_mm <= axis->max_au + kRounding_mm) {
    return fault(corrected.high_mm, axis->max_au, original.high_mm);
  }
  if (corrected.low_mm < axis->min_au - kRounding_mm &&
      original.low_mm >= axis->min_au - kRounding_mm) {
    return fault(corrected.low_mm, axis->min_au, original.low_mm);
  }
  return {};
}

std::string over_travel(std::span<const kernel::machine::Axis> axes, const Plan& plan,
                        const Move& original, const Move& corrected) {
  std::string fault;
  for (std::size_t i = 0; fault.empty() && i < plan.axes.size(); ++i) {
    // Reach includes the bulges of arcs, which leave the travel before the ends do.
    const AxisPlan& axis = plan.axes[i];
    fault = over_travel(axes, axis.letter, reach_of(original, axis.index),
                        reach_of(corrected, axis.index));
  }
  return fault;
}

}  // namespace steadyrest::nc::rewrite
