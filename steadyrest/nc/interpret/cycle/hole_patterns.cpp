// SPDX-License-Identifier: Apache-2.0
#include <cmath>
#include <string_view>

#include <steadyrest/kernel/units/constants.hpp>
#include <steadyrest/nc/interpret/control/coordinates.hpp>
#include <steadyrest/nc/interpret/control/worded_end.hpp>
#include <steadyrest/nc/interpret/cycle/hole_patterns.hpp>

namespace steadyrest::nc::interpret {

bool HolePatterns::drill(const Step& step) {
  const int pattern = step.fanuc.pattern;
  const auto refuse_pattern = [&](std::string_view reason, std::string_view text) {
    return refusals_.g_word(step, pattern, reason, text);
  };
  if (pattern == g::kHolesOnLine) {
    return refuse_pattern("g_code_not_interpreted",
                          "holes along a line (G72) are not interpreted: whether the first is at "
                          "the tool's place is not certain");
  }
  const bool arc = pattern == g::kHolesOnArc;
  if (!step.has('I') || !step.has('L') || (arc && !step.has('K')) || step['I'] == 0.0 ||
      step['L'] < 1.0) {
    return refuse_pattern("cycle_word_missing",
                          arc ? "G71 needs radius (I), spacing (K) and number of holes (L)"
                              : "G70 needs radius (I) and number of holes (L)");
  }
  if (state_.plane != Plane::xy || state_.polar.on) {
    return refuse_pattern("pattern_plane", "a pattern of holes outside G17, or under G16");
  }
  const double count = step['L'];
  const double radius_mm = std::abs(step['I']) * state_.unit_mm;
  const double first_deg = step.has('J') ? step['J'] : 0.0;
  const double sense = step['I'] < 0.0 ? -1.0 : 1.0;
  const double spacing_deg = arc ? step['K'] : sense * 360.0 / count;
  const Axes centre = end_point(step, control_);
  const auto place_of = [&](double hole) {
    const double angle = (first_deg + hole * spacing_deg) * kernel::units::kDegree;
    const std::array<double, 3> from_centre =
        state_.text_frame.distance({radius_mm * std::cos(angle), radius_mm * std::sin(angle), 0.0});
    return PlanePoint{.first = centre[0] + from_centre[0], .second = centre[1] + from_centre[1]};
  };
  // The cycle has only its own words.
  Step words = step;
  words.mask &= ~(kCentreMask | Step::bit('L') | Step::bit('X') | Step::bit('Y'));
  return drilling_.cycle(words, {.count = count, .place = place_of});
}

}  // namespace steadyrest::nc::interpret
