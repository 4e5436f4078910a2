// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <cmath>

#include <steadyrest/nc/interpret/state/arc.hpp>

namespace steadyrest::nc::interpret {

// LinuxCNC 2.9's bounds, found by bisection with rs274 (README.md). In inch mode the spiral's
// bounds are LinuxCNC's own constants, 0.0028 in and 0.28 in, not the metric ones converted.
ArcTolerance arc_tolerance(bool inch) noexcept {
  if (!inch) {
    return {};
  }
  return {.radius_mm = 0.00005 * 25.4,
          .spiral_mm = 0.0028284271247461903 * 25.4,
          .spiral_ratio = 0.001,
          .spiral_most_mm = 0.28284271247461903 * 25.4};
}

// With chord c from start to end, m its midpoint, n its left normal:  centre = m + s·√(R² −
// c²/4)·n. The short clockwise arc has its centre on the right (s = −1), the long one on the left;
// counter-clockwise the other way round.
std::expected<PlanePoint, ArcFault> centre_from_radius(PlanePoint start, PlanePoint end,
                                                       double radius_mm, bool clockwise,
                                                       const ArcTolerance& tolerance) noexcept {
  const double along_first = end.first - start.first;
  const double along_second = end.second - start.second;
  const double chord = std::hypot(along_first, along_second);
  // Any centre at distance R would do: a full circle needs its centre given in words.
  if (chord == 0.0) {
    return std::unexpected(ArcFault::no_chord);
  }
  const double half = 0.5 * chord;
  const double radius = std::abs(radius_mm);
  // A radius short of half the chord by no more than the tolerance is CAM rounding: a half circle
  // is meant.
  if (half - radius > tolerance.radius_mm) {
    return std::unexpected(ArcFault::radius_too_small);
  }
  // (R − c/2)·(R + c/2) instead of R² − c²/4 avoids cancellation. Just above c/2 rounding could
  // make it negative, so the height is 0 there.
  const double height =
      half / radius > 1.0 - 1e-12 ? 0.0 : std::sqrt((radius - half) * (radius + half));
  const double side = (radius_mm > 0.0) == clockwise ? -height : height;
  return PlanePoint{.first = 0.5 * (start.first + end.first) - side * along_second / chord,
                    .second = 0.5 * (start.second + end.second) + side * along_first / chord};
}

std::expected<void, ArcFault> check_centre(PlanePoint start, PlanePoint end, PlanePoint centre,
                                           const ArcTolerance& tolerance) noexcept {
  const double at_start = std::hypot(centre.first - start.first, centre.second - start.second);
  const double at_end = std::hypot(centre.first - end.first, centre.second - end.second);
  if (at_start < tolerance.radius_mm || at_end < tolerance.radius_mm) {
    return std::unexpected(ArcFault::zero_radius);
  }
  // Words are rounded, so the two radii never agree exactly. The relative bound allows more for
  // large arcs; the absolute one also catches a wrong word on any arc.
  const double miss = std::abs(at_start - at_end);
  if (miss > tolerance.spiral_most_mm ||
      (miss > tolerance.spiral_mm && miss > tolerance.spiral_ratio * std::max(at_start, at_end))) {
    return std::unexpected(ArcFault::does_not_close);
  }
  return {};
}

}  // namespace steadyrest::nc::interpret
