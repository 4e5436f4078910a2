// SPDX-License-Identifier: Apache-2.0
#include <cmath>

#include <steadyrest/nc/plan/time/cyclogram.hpp>

namespace steadyrest::nc::plan {

std::string_view name(Load load) noexcept {
  return load == Load::standing ? "standing" : load == Load::running ? "running" : "cutting";
}

// Speeds within 5 % of the transition's first speed count as the same: under G96 the speed changes
// with every block, and each change would begin a transition. Comparing with the first speed, not
// the last, lets a slow drift begin a new one. Beyond kMost the last transition takes everything.
bool Cyclogram::goes_on(const Setpoint& setpoint, std::int64_t tool) const noexcept {
  constexpr double kSame = 0.05;
  if (transitions_.empty()) {
    return false;
  }
  const Transition& last = transitions_.back();
  const double from = last.speed_rev_s;
  const bool same = std::abs(setpoint.spindle_rev_s - from) <= kSame * std::abs(from);
  return (same && tool == last.tool && setpoint.coolant == last.coolant) ||
         transitions_.size() >= kMost;
}

void Cyclogram::add(const Setpoint& setpoint, std::int64_t tool, double time_s, double period_s) {
  if (!goes_on(setpoint, tool)) {
    transitions_.push_back({.tool = tool,
                            .speed_rev_s = setpoint.spindle_rev_s,
                            .start_s = time_s,
                            .coolant = setpoint.coolant,
                            .line = setpoint.line});
  }
  Transition& now = transitions_.back();
  now.seconds += period_s;
  now.path_mm += setpoint.path_speed_mm_s * period_s;
  // Rapids, dwells and probing cut nothing: they count towards the transition, not the cut.
  if (kernel::signal::in_cut(setpoint.motion)) {
    now.cut_s += period_s;
    now.cut_mm += setpoint.path_speed_mm_s * period_s;
  }
}

}  // namespace steadyrest::nc::plan
