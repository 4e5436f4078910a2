// SPDX-License-Identifier: Apache-2.0
#include <cmath>

#include <steadyrest/contour/offline/predistort/polish/planar_arc.hpp>
#include <steadyrest/kernel/units/constants.hpp>

namespace steadyrest::contour::offline {
namespace {

constexpr double kStraight_1_mm = 1e-9;

/// The length of an arc's tangents up to where they meet.
double tangent_mm(const PlanarArc& arc) noexcept {
  return std::abs(arc.curvature_1_mm) < kStraight_1_mm
             ? 0.5 * arc.length_mm
             : std::abs(std::tan(0.5 * arc.curvature_1_mm * arc.length_mm) / arc.curvature_1_mm);
}

}  // namespace

Heading along(const PlanarArc& arc, double distance_mm) noexcept {
  const Heading& at = arc.start;
  const double turned = arc.curvature_1_mm * distance_mm;
  // The chord, halfway turned; sin(x)/x by its series where both vanish.
  const double half = 0.5 * turned;
  const double chord =
      distance_mm * (std::abs(half) < 1e-4 ? 1.0 - half * half / 6.0 : std::sin(half) / half);
  return {.x_mm = at.x_mm + chord * std::cos(at.angle_rad + half),
          .y_mm = at.y_mm + chord * std::sin(at.angle_rad + half),
          .angle_rad = at.angle_rad + turned};
}

PlanarArc arc_to(const Heading& from, double x_mm, double y_mm) noexcept {
  const double dx = x_mm - from.x_mm;
  const double dy = y_mm - from.y_mm;
  const double chord = std::hypot(dx, dy);
  // Between the direction and the chord: half of what the arc turns.
  const double half = std::remainder(std::atan2(dy, dx) - from.angle_rad, kernel::units::kTurn);
  const double sine = std::sin(half);
  PlanarArc out{.start = from, .curvature_1_mm = 0.0, .length_mm = chord};
  if (chord > 0.0 && std::abs(sine) > kStraight_1_mm * chord) {
    out.curvature_1_mm = 2.0 * sine / chord;
    out.length_mm = 2.0 * half / out.curvature_1_mm;
  }
  return out;
}

std::optional<std::array<PlanarArc, 2>> biarc(const Heading& from, const Heading& to,
                                              double ratio) noexcept {
  const double ax = std::cos(from.angle_rad);
  const double ay = std::sin(from.angle_rad);
  const double bx = std::cos(to.angle_rad);
  const double by = std::sin(to.angle_rad);
  const double vx = to.x_mm - from.x_mm;
  const double vy = to.y_mm - from.y_mm;
  const double square = vx * vx + vy * vy;
  const double along = vx * (ratio * ax + bx) + vy * (ratio * ay + by);
  const double bend = 2.0 * ratio * (1.0 - (ax * bx + ay * by));  // ≥ 0
  // bend·d² + 2·along·d − v² = 0; the root that stays where bend vanishes.
  const double root = along + std::sqrt(along * along + bend * square);
  const double second = square / root;
  const double first = ratio * second;
  if (!(root > 0.0) || !(square > 0.0) || !std::isfinite(second)) {
    return std::nullopt;
  }
  const double share = first / (first + second);
  const double mx = from.x_mm + first * ax + share * (vx - first * ax - second * bx);
  const double my = from.y_mm + first * ay + share * (vy - first * ay - second * by);
  std::array<PlanarArc, 2> out{arc_to(from, mx, my), {}};
  out[1] = arc_to(offline::along(out[0], out[0].length_mm), to.x_mm, to.y_mm);
  return out;
}

double biarc_ratio(const PlanarArc& first, const PlanarArc& second) noexcept {
  const double ratio = tangent_mm(first) / tangent_mm(second);
  return std::isfinite(ratio) && ratio > 0.0 ? ratio : 1.0;
}

}  // namespace steadyrest::contour::offline
