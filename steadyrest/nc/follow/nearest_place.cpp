// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <cmath>

#include <steadyrest/math/geometry/foot_point.hpp>
#include <steadyrest/math/geometry/segment.hpp>
#include <steadyrest/nc/follow/nearest_place.hpp>

namespace steadyrest::nc::follow {
namespace {

using kernel::signal::PathSegment;
using kernel::signal::Point;

constexpr double kRotaryWeight = 10.0;  ///< mm for a radian
constexpr double kNoLength_mm = 1e-6;

Point linear(const kernel::signal::AxisValues& point) noexcept {
  return {point[0], point[1], point[2]};
}

/// Distance of the axes beyond the third at u, as a length.
double others_away(const PathSegment& segment, const kernel::signal::AxisValues& point,
                   double u) noexcept {
  double sum = 0.0;
  for (std::size_t i = 0; i < segment.other_start.size(); ++i) {
    const double there = std::lerp(segment.other_start[i], segment.other_end[i], u);
    sum += std::pow(kRotaryWeight * (point[i + 3] - there), 2);
  }
  return std::sqrt(sum);
}

/// The place of the other axes on a segment that moves them alone.
double u_of_others(const PathSegment& segment, const kernel::signal::AxisValues& point) noexcept {
  double along = 0.0;
  double length = 0.0;
  for (std::size_t i = 0; i < segment.other_start.size(); ++i) {
    const double step = segment.other_end[i] - segment.other_start[i];
    along += step * (point[i + 3] - segment.other_start[i]);
    length += step * step;
  }
  return length > 0.0 ? along / length : 0.0;
}

}  // namespace

Nearest nearest(const PathSegment& segment, const kernel::signal::AxisValues& point, double low_mm,
                double high_mm, double expected_mm) noexcept {
  namespace geometry = math::geometry;
  const double u_low = geometry::parameter_at(segment, low_mm);
  const double u_high = geometry::parameter_at(segment, high_mm);
  const double u_near = geometry::parameter_at(segment, expected_mm);
  geometry::Foot foot = geometry::foot_point(segment, linear(point), u_low, u_high, u_near);
  if (geometry::arc_length_mm(segment) < kNoLength_mm) {
    foot.u = std::clamp(u_of_others(segment, point), u_low, u_high);
  }
  return {.position_mm = segment.position_mm + geometry::distance_at(segment, foot.u),
          .away_mm = std::hypot(foot.distance_mm, others_away(segment, point, foot.u))};
}

}  // namespace steadyrest::nc::follow
