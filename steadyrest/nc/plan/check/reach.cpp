// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <cmath>
#include <numbers>

#include <steadyrest/nc/plan/check/reach.hpp>

namespace steadyrest::nc::plan {
namespace {

using interpret::Axes;
using interpret::Move;
using interpret::MoveKind;

constexpr double kFullTurn = 2.0 * std::numbers::pi;

/// Where an arc swings, by angles from its start.
struct Swing {
  double swept_rad = 0.0;
  double slack_rad = 0.0;
  double beyond_mm = 0.0;

  [[nodiscard]] bool passes(double behind_rad) const noexcept { return behind_rad <= swept_rad; }
  /// How far a point may lie beyond the ends near a direction that the arc does not pass.
  [[nodiscard]] double beside_mm(double behind_rad) const noexcept {
    const bool is_near = behind_rad <= swept_rad + slack_rad || behind_rad >= kFullTurn - slack_rad;
    return is_near ? beyond_mm : 0.0;
  }
};

/// A spiral or helix turns back a little before or after the direction: s·(r′·cos φ − r·sin φ) + h′
/// = 0, so within asin((s·r′ + h′)/(s·r)) of it. For an arc that does not pass the direction
/// itself, this adds at most the total change of s·r and h to its end.
Swing swing_of(double swept_rad, double changes_mm, double least_mm) noexcept {
  const double sine = changes_mm / (swept_rad * std::max(1e-9, least_mm));
  return {.swept_rad = swept_rad,
          .slack_rad = sine < 1.0 ? std::asin(sine) : kFullTurn,
          .beyond_mm = changes_mm};
}

/// Extends the ends of an arc to where it passes the axis' direction from its centre. The work
/// coordinates may be turned out of the arc's plane.
/// With s1, s2 = the components of the plane's two directions along the machine's axis, a point at
/// angle θ on radius r is at centre + r·(s1·cos θ + s2·sin θ). The extremes are ±r·√(s1² + s2²), at
/// θ = atan2(s2, s1) and opposite. They count where the arc passes these angles.
void bulge(const Move& move, std::size_t axis, Reach& reach) noexcept {
  if (axis >= move.normal.size()) {
    return;
  }
  const auto* const largest =
      std::ranges::max_element(move.normal, {}, [](double part) { return std::abs(part); });
  // Cyclic order keeps first, second, normal right-handed: G18's first direction is Z, as controls
  // count.
  const auto normal = static_cast<std::size_t>(largest - move.normal.begin());
  const std::size_t first = (normal + 1) % 3;
  const std::size_t second = (normal + 2) % 3;
  Axes centre = move.start;
  std::ranges::copy(move.centre_mm, centre.begin());
  const double centre_mm = machine_of(move, centre)[axis];
  const auto along = [&](std::size_t direction) {  // of the work coordinates, on the machine's axis
    Axes at = centre;
    at[direction] += 1.0;
    return machine_of(move, at)[axis] - centre_mm;
  };
  const double share = std::hypot(along(first), along(second));
  // The arc's plane is perpendicular to the axis: the ends suffice.
  if (share < 1e-9) {
    return;
  }
  const auto angle = [&](const Axes& at) {
    return std::atan2(at[second] - centre[second], at[first] - centre[first]);
  };
  const auto behind_start = [&](double at) {  // in the direction of travel, 0 … 2π
    const double ahead = (move.turns < 0 ? -1.0 : 1.0) * (at - angle(move.start));
    return ahead - kFullTurn * std::floor(ahead / kFullTurn);
  };
  const auto from_centre_mm = [&](const Axes& at) {
    return std::hypot(at[first] - centre[first], at[second] - centre[second]);
  };
  double swept = behind_start(angle(move.end));
  // Back at the start, or more than one turn begun: every direction is passed.
  if (std::abs(move.turns) > 1 || swept < 1e-9) {
    swept = kFullTurn;
  }
  // A bound, not the exact extreme: the larger radius of a spiral and the whole rise of a helix,
  // which affects this axis only where a rotation turns the plane's normal towards it.
  const double radius_mm = from_centre_mm(move.start);
  const double radius_end_mm = from_centre_mm(move.end);
  const double bulge_mm = share * std::max(radius_mm, radius_end_mm);
  const double helix_mm = (move.end[normal] - move.start[normal]) * along(normal);
  const double changes_mm = share * std::abs(radius_end_mm - radius_mm) + std::abs(helix_mm);
  const Swing swing = swing_of(swept, changes_mm, share * std::min(radius_mm, radius_end_mm));
  const double high_at = std::atan2(along(second), along(first));
  if (swing.passes(behind_start(high_at))) {
    reach.high_mm = std::max(reach.high_mm, centre_mm + bulge_mm + std::max(helix_mm, 0.0));
  } else {
    reach.high_mm += swing.beside_mm(behind_start(high_at));
  }
  const double low_at = high_at + std::numbers::pi;
  if (swing.passes(behind_start(low_at))) {
    reach.low_mm = std::min(reach.low_mm, centre_mm - bulge_mm + std::min(helix_mm, 0.0));
  } else {
    reach.low_mm -= swing.beside_mm(behind_start(low_at));
  }
}

}  // namespace

Reach reach_of(const Move& move, std::size_t axis) noexcept {
  const double start_mm = machine_of(move, move.start)[axis];
  const double end_mm = machine_of(move, move.end)[axis];
  Reach reach{.low_mm = std::min(start_mm, end_mm), .high_mm = std::max(start_mm, end_mm)};
  if (move.kind == MoveKind::arc) {
    bulge(move, axis, reach);
  }
  for (const interpret::SplinePoint& point : move.spline) {  // the curve lies within their hull
    Axes at = move.start;
    at[0] = point.x_mm;
    at[1] = point.y_mm;
    const double at_mm = machine_of(move, at)[axis];
    reach.low_mm = std::min(reach.low_mm, at_mm);
    reach.high_mm = std::max(reach.high_mm, at_mm);
  }
  return reach;
}

}  // namespace steadyrest::nc::plan
