// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <steadyrest/kernel/signal/path.hpp>

/// Evaluates a piece of path: point, tangent and curvature by parameter or by path length.
///
/// Law: kernel/signal/path.hpp. With ω = sweep, ρ = radius_end − radius, r(u) = radius + u·ρ:
///   p′(u) = ρ·c(u) + r·ω·d(u) + rise·axis,   p″(u) = 2ρω·d(u) − r·ω²·c(u)
/// where c, d are the rotating unit vectors. |p′|² = ρ² + rise² + (r·ω)², so the length of a spiral
/// is the integral of √(m² + (ωr)²), m² = ρ² + rise², in closed form.
///
/// Everything is noexcept, allocates nothing and holds no state.
namespace steadyrest::math::geometry {

/// A point of the path with its derivatives by path length.
struct Station {
  kernel::signal::Point point_mm{};
  kernel::signal::Point tangent{};         ///< unit vector in the direction of travel
  kernel::signal::Point curvature_1_mm{};  ///< towards the centre of curvature, length 1/R
};

/// The frame of an arc: unit vectors from the centre to the start and a quarter turn ahead.
struct ArcFrame {
  kernel::signal::Point e1{};
  kernel::signal::Point e2{};
};
[[nodiscard]] ArcFrame arc_frame(const kernel::signal::PathSegment& segment) noexcept;

/// p(u); u outside of [0, 1] continues the law.
[[nodiscard]] kernel::signal::Point point_at(const kernel::signal::PathSegment& segment,
                                             double u) noexcept;

/// Point, tangent and curvature at u. A segment of zero length has the tangent (0, 0, 0).
[[nodiscard]] Station station_at(const kernel::signal::PathSegment& segment, double u) noexcept;

/// Length by geometry in mm; equals `length_mm` except for moves of rotary axes alone.
[[nodiscard]] double arc_length_mm(const kernel::signal::PathSegment& segment) noexcept;

/// The parameter u of the point `distance_mm` (as measured by `length_mm`) after the start, clamped
/// to [0, 1]. Linear except on spirals, where Newton's method finishes within 1e-12.
[[nodiscard]] double parameter_at(const kernel::signal::PathSegment& segment,
                                  double distance_mm) noexcept;

/// The inverse of parameter_at: path length from the start to u.
[[nodiscard]] double distance_at(const kernel::signal::PathSegment& segment, double u) noexcept;

/// The part of a segment between two distances from its start, 0 ≤ from < to ≤ length. Its ends are
/// the segment's own where it begins or ends with it; axes beyond the third and `position_mm` go in
/// proportion, what limits the speed is the segment's.
[[nodiscard]] kernel::signal::PathSegment part_of(const kernel::signal::PathSegment& segment,
                                                  double from_mm, double to_mm) noexcept;

}  // namespace steadyrest::math::geometry
