// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <steadyrest/kernel/signal/path.hpp>

namespace steadyrest::math::geometry {

/// The point of a segment nearest to another point.
struct Foot {
  double u = 0.0;  ///< parameter on the segment
  double distance_mm = 0.0;
  kernel::signal::Point point_mm{};
};

/// The foot point of `query` on the part u_low … u_high of a segment, 0 ≤ u_low ≤ u_high ≤ 1.
///
/// Lines by projection and circles by angle, both in closed form (exact to rounding). Where several
/// turns of a circle are equally near, the one nearest to u_near is taken. Helices and spirals:
/// samples at most π/6 apart (at most two turns about u_near), then Newton's method on (p(u) −
/// q)·p′(u) = 0 within a bracket, bisection where Newton leaves it, at most 12 steps; converges to
/// rounding (tested at 1e-9 mm). Arcs of less than a turn whose radius grows by at most 0.1 %, as
/// rounded texts have them, begin at the circle's foot instead. Bounded work, no allocation. The
/// foot point of a circle's own axis is any of its points.
[[nodiscard]] Foot foot_point(const kernel::signal::PathSegment& segment,
                              const kernel::signal::Point& query, double u_low, double u_high,
                              double u_near) noexcept;

/// On the whole segment.
[[nodiscard]] inline Foot foot_point(const kernel::signal::PathSegment& segment,
                                     const kernel::signal::Point& query) noexcept {
  return foot_point(segment, query, 0.0, 1.0, 0.5);
}

}  // namespace steadyrest::math::geometry
