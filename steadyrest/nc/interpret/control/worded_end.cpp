// SPDX-License-Identifier: Apache-2.0
#include <cmath>

#include <steadyrest/kernel/units/constants.hpp>
#include <steadyrest/nc/interpret/control/coordinates.hpp>
#include <steadyrest/nc/interpret/control/worded_end.hpp>

namespace steadyrest::nc::interpret {

Axes worded_end(const Step& step, const State& state) noexcept {
  const TextFrame& frame = state.text_frame;
  const PlaneAxes plane = axes_of(state.plane);
  Axes words = frame.on ? frame.to_words(state.position) : state.position;
  std::uint32_t named = 0;
  for (std::size_t i = 0; i < kAxisLetters.size(); ++i) {
    const std::uint32_t bit = Step::bit(kAxisLetters[i]);
    if ((step.mask & bit) == 0) {
      continue;
    }
    named |= 1U << i;
    const bool incremental =
        (step.incremental & bit) != 0 || (state.incremental && (step.absolute & bit) == 0);
    words[i] = component(step, i, state) + (incremental ? words[i] : 0.0);
  }
  const std::uint32_t in_plane = (1U << plane.first) | (1U << plane.second);
  if (state.polar.on && (named & in_plane) != 0) {
    const double angle = state.polar.angle_deg * kernel::units::kDegree;
    words[plane.first] = state.polar.radius_mm * std::cos(angle);
    words[plane.second] = state.polar.radius_mm * std::sin(angle);
    named |= in_plane;
  }
  if (!frame.on) {
    return words;
  }
  if (frame.rotated) {
    const std::uint32_t turned = (1U << frame.first) | (1U << frame.second);
    named |= (named & turned) != 0 ? turned : 0U;
  }
  // An axis that no word moves keeps its place to the last bit.
  const Axes work = frame.to_work(words);
  Axes end = state.position;
  for (std::size_t i = 0; i < end.size(); ++i) {
    end[i] = ((named >> i) & 1U) != 0 ? work[i] : end[i];
  }
  return end;
}

// FANUC Series 30i, "Polar coordinate command": the plane's first axis is the radius, the second
// the angle, counter-clockwise from the first. A radius in G91 would count from where the tool is.
bool take_polar(const Step& step, State& state, Refusals& refusals) {
  PolarWords& polar = state.polar;
  const PlaneAxes plane = axes_of(state.plane);
  const char radius = kAxisLetters[plane.first];
  const char angle = kAxisLetters[plane.second];
  if (!polar.on || (!step.has(radius) && !step.has(angle))) {
    return true;
  }
  if (step.has(radius)) {
    if (state.incremental) {
      return refusals.letter(step, radius, "polar_incremental",
                             "a polar radius in G91 counts from the tool's place, which is not "
                             "interpreted; write it in G90");
    }
    polar.radius_mm = step[radius] * state.unit_mm;
    polar.radius_known = true;
  }
  if (step.has(angle)) {
    if (state.incremental && !polar.angle_known) {
      return refusals.letter(step, angle, "polar_incremental",
                             "an incremental polar angle before any absolute one");
    }
    polar.angle_deg = step[angle] + (state.incremental ? polar.angle_deg : 0.0);
    polar.angle_known = true;
  }
  return (polar.radius_known && polar.angle_known) ||
         refusals.letter(step, polar.radius_known ? radius : angle, "polar_word_missing",
                         "the first place after G16 needs both radius and angle");
}

}  // namespace steadyrest::nc::interpret
