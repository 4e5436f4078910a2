// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <optional>

namespace steadyrest::contour::offline {

/// A point of a plane and a direction of travel through it.
struct Heading {
  double x_mm = 0.0;
  double y_mm = 0.0;
  double angle_rad = 0.0;
};

/// A line or an arc in a plane from a place on; curvature > 0 turns left, 0 is a line.
struct PlanarArc {
  Heading start;
  double curvature_1_mm = 0.0;
  double length_mm = 0.0;
};

/// `distance_mm` along the arc; beyond its ends it goes on.
[[nodiscard]] Heading along(const PlanarArc& arc, double distance_mm) noexcept;

/// The arc from a place to a point, less than one turn; the line where the point lies ahead.
[[nodiscard]] PlanarArc arc_to(const Heading& from, double x_mm, double y_mm) noexcept;

/// Two arcs from place to place without a bend.
///
/// Law: with the tangent lengths d₁ = ρ·d₂ of both arcs, v the chord and t₀, t₁ the directions,
///   v² − 2·d₂·v·(ρ·t₀ + t₁) + 2·ρ·d₂²·(t₀·t₁ − 1) = 0, d₂ > 0;
/// they meet where the tangents' ends are joined, in the ratio ρ. Nothing where no d₂ is positive.
/// Source: K. Bolton, Biarc curves, Computer-Aided Design 7 (1975) 89.
[[nodiscard]] std::optional<std::array<PlanarArc, 2>> biarc(const Heading& from, const Heading& to,
                                                            double ratio) noexcept;
/// ρ of two arcs that follow one another; 1 where it has no value.
[[nodiscard]] double biarc_ratio(const PlanarArc& first, const PlanarArc& second) noexcept;

}  // namespace steadyrest::contour::offline
