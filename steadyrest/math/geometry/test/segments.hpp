// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <numbers>

#include <rapidcheck.h>

#include <steadyrest/math/geometry/segment.hpp>
#include <steadyrest/math/geometry/vector.hpp>

/// Segments for tests: made from their geometry, with lengths and end points filled in.
namespace steadyrest::math::geometry::test {

inline rc::Gen<double> number(double low, double high) {
  return rc::gen::map(
      rc::gen::inRange<std::int64_t>(0, std::int64_t{1} << 40), [=](std::int64_t n) {
        return low +
               (high - low) * static_cast<double>(n) / static_cast<double>(std::int64_t{1} << 40);
      });
}

inline rc::Gen<Point> point(double size) {
  return rc::gen::map(rc::gen::tuple(number(-size, size), number(-size, size), number(-size, size)),
                      [](const std::tuple<double, double, double>& t) {
                        return Point{std::get<0>(t), std::get<1>(t), std::get<2>(t)};
                      });
}

inline kernel::signal::PathSegment line(const Point& start, const Point& end) {
  kernel::signal::PathSegment segment;
  segment.start_mm = start;
  segment.end_mm = end;
  segment.length_mm = distance(start, end);
  return segment;
}

inline kernel::signal::PathSegment arc(const Point& centre, const Point& axis, double radius,
                                       double radius_end, double start_angle, double sweep,
                                       double rise) {
  kernel::signal::PathSegment segment;
  segment.geometry = kernel::signal::Geometry::arc;
  segment.centre_mm = centre;
  segment.axis = unit(axis);
  const Point away = std::abs(segment.axis[0]) < 0.9 ? Point{1, 0, 0} : Point{0, 1, 0};
  const Point x = unit(add_scaled(away, segment.axis, -dot(away, segment.axis)));
  const Point y = cross(segment.axis, x);
  segment.radius_mm = radius;
  segment.radius_end_mm = radius_end;
  segment.sweep_rad = sweep;
  segment.rise_mm = rise;
  segment.start_mm = add_scaled(add_scaled(centre, x, radius * std::cos(start_angle)), y,
                                radius * std::sin(start_angle));
  segment.end_mm = point_at(segment, 1.0);
  segment.length_mm = arc_length_mm(segment);
  return segment;
}

/// An arc of any kind: kind 0 circle, 1 helix, 2 spiral, 3 conical helix.
inline rc::Gen<kernel::signal::PathSegment> any_arc() {
  return rc::gen::exec([] {
    const int kind = *rc::gen::inRange(0, 4);
    Point axis = *point(1.0);
    if (norm(axis) < 1e-3) {
      axis = {0, 0, 1};
    }
    const double radius = *number(0.5, 40.0);
    const double end = kind >= 2 ? *number(0.5, 40.0) : radius;
    const double rise = kind % 2 == 1 ? *number(0.1, 10.0) : 0.0;
    return arc(*point(50.0), axis, radius, end, *number(0.0, 6.0), *number(0.1, 12.0), rise);
  });
}

inline rc::Gen<kernel::signal::PathSegment> any_segment() {
  return rc::gen::exec([] {
    if (*rc::gen::inRange(0, 4) == 0) {
      return line(*point(50.0), add(*point(50.0), Point{0, 0, 200.0}));
    }
    return *any_arc();
  });
}

}  // namespace steadyrest::math::geometry::test
