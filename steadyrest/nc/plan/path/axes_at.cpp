// SPDX-License-Identifier: Apache-2.0
#include <algorithm>

#include <steadyrest/math/geometry/segment.hpp>
#include <steadyrest/nc/plan/path/axes_at.hpp>

namespace steadyrest::nc::plan {

// Axes other than X Y Z follow u, the share of the segment covered. On a spiral u is not
// proportional to the length, so parameter_at() must find it.
PathPoint axes_at(const kernel::signal::PathSegment& segment, double distance_mm) noexcept {
  PathPoint out;
  const double length = segment.length_mm;
  const double u = math::geometry::parameter_at(segment, distance_mm);
  const double per_mm = length > 0.0 ? 1.0 / length : 0.0;
  if (segment.geometry == kernel::signal::Geometry::arc) {
    const auto station = math::geometry::station_at(segment, u);
    std::copy(station.point_mm.begin(), station.point_mm.end(), out.position.begin());
    std::copy(station.tangent.begin(), station.tangent.end(), out.direction.begin());
  } else {
    for (std::size_t i = 0; i < 3; ++i) {
      const double delta = segment.end_mm[i] - segment.start_mm[i];
      out.position[i] = segment.start_mm[i] + u * delta;
      out.direction[i] = delta * per_mm;
    }
  }
  for (std::size_t i = 0; i < segment.other_start.size(); ++i) {
    const double delta = segment.other_end[i] - segment.other_start[i];
    out.position[i + 3] = segment.other_start[i] + u * delta;
    out.direction[i + 3] = delta * per_mm;
  }
  // Exactly the programmed end: start + 1·(end − start) may miss it by a rounding error, and the
  // next segment starts from the programmed point.
  if (distance_mm >= length) {
    std::copy(segment.end_mm.begin(), segment.end_mm.end(), out.position.begin());
    std::copy(segment.other_end.begin(), segment.other_end.end(), out.position.begin() + 3);
  }
  return out;
}

}  // namespace steadyrest::nc::plan
