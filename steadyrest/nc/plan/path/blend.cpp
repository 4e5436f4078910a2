// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <cmath>
#include <numbers>

#include <steadyrest/math/geometry/vector.hpp>
#include <steadyrest/nc/plan/path/blend.hpp>

namespace steadyrest::nc::plan {
namespace {

double tolerance_of(const BlendSide& side) {
  const double quarter = 0.25 * side.nominal_mm;
  return side.program_tolerance_mm > 0.0 ? std::min(side.program_tolerance_mm, quarter) : quarter;
}

/// Angle of an arc that the rounding may take.
double share_of_sweep(const BlendSide& side, double share, double half_inner_rad) {
  const double most = side.convex ? half_inner_rad : 0.5 * std::numbers::pi;
  return std::min(share * side.sweep_rad, most);
}

}  // namespace

BlendArc blend_arc(const BlendSide& before, const BlendSide& after, double turn_rad,
                   const PlaneLimits& plane, double centripetal_share) noexcept {
  BlendArc out;
  const double half_inner = 0.5 * (std::numbers::pi - turn_rad);
  double theta = half_inner;  // what the chords make of it
  const auto room = [&](const BlendSide& side, double sweep_share, double& most_mm) {
    if (!side.arc) {
      most_mm = std::min(side.length_mm, 0.5 * side.nominal_mm);
      return most_mm;
    }
    const double angle = share_of_sweep(side, sweep_share, half_inner);
    most_mm = angle * side.radius_mm;
    if (!side.convex) {
      return most_mm;
    }
    theta = std::min(theta, half_inner - 0.25 * angle);
    return std::sin(0.25 * angle) * side.radius_mm;
  };
  const double length = std::min(room(before, 2.0 / 3.0, out.room_before_mm),
                                 room(after, 1.0 / 3.0, out.room_after_mm));
  out.tolerance_mm = std::min(tolerance_of(before), tolerance_of(after));
  const double turn = std::numbers::pi - 2.0 * theta;
  const double slope = std::tan(0.5 * turn);
  // d: along the sides; 1/cos − 1 of half the turn without cancellation.
  const double by_tolerance = out.tolerance_mm * std::cos(theta) /
                              std::max(1e-15, 2.0 * std::pow(std::sin(0.25 * turn), 2));
  const double d = std::min(length, by_tolerance);
  const double widest = d / slope;
  const double across = centripetal_share * plane.acceleration_mm_s2;
  const double goal = std::min(std::max(before.speed_mm_s, after.speed_mm_s), plane.speed_mm_s);
  const double u = std::min(goal, std::sqrt(across * widest));
  const double slowest = std::min(u, std::sqrt(plane.acceleration_mm_s2 * d));
  const double long_enough = 2.0 * u * slowest / (plane.acceleration_mm_s2 * turn);
  out.radius_mm = std::max(u * u / across, std::min(long_enough, widest));
  out.speed_mm_s = u;
  return out;
}

Overlap overlap(const BlendSide& before, const BlendSide& after, double ramp_share,
                double length_share) noexcept {
  const double a1 = before.overlap_mm_s2(ramp_share);
  const double a2 = after.overlap_mm_s2(ramp_share);
  const double l1 = length_share * before.length_mm;
  const double l2 = length_share * after.length_mm;
  Overlap out;
  out.before_mm_s = std::min(before.speed_mm_s, std::sqrt(a1 * l1));
  out.after_mm_s = std::min(after.speed_mm_s, std::sqrt(a2 * l2));
  const double most_s =
      std::min(before.length_mm / out.before_mm_s, after.length_mm / out.after_mm_s);
  const double t = std::min(most_s, std::max(out.before_mm_s / a1, out.after_mm_s / a2));
  out.before_mm_s = std::min(out.before_mm_s, t * a1);
  out.after_mm_s = std::min(out.after_mm_s, t * a2);
  const double cosine = std::clamp(-math::geometry::dot(before.bend, after.bend), -1.0, 1.0);
  const double theta = 0.5 * std::acos(cosine);
  if (before.program_tolerance_mm > 0.0 && std::cos(theta) > 1e-3) {
    const double most = 2.0 * std::sqrt(a1 * before.program_tolerance_mm / std::cos(theta));
    out.before_mm_s = std::min(out.before_mm_s, most);
    out.after_mm_s = std::min(out.after_mm_s, most);
  }
  out.kept_mm_s = 0.5 * std::sin(theta) * (out.before_mm_s + out.after_mm_s);
  return out;
}

}  // namespace steadyrest::nc::plan
