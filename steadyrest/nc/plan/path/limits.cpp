// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <cmath>

#include <steadyrest/nc/plan/path/limits.hpp>

namespace steadyrest::nc::plan {

using kernel::machine::kUnlimited;
using kernel::signal::AxisValues;
using kernel::signal::kMaxAxes;
using kernel::signal::PathSegment;
using kernel::signal::Point;

// Rotary axes have rad/s and rad/s² in these fields, and directions have rad per mm of path, so the
// quotients below come out in mm/s and mm/s² for them too.
PathLimits::PathLimits(std::span<const kernel::machine::Axis> axes,
                       const kernel::machine::Control& control)
    : path_acceleration_mm_s2_(control.max_path_acceleration_mm_s2),
      period_s_(control.interpolator_period_s),
      deviation_mm_(control.junction_deviation_mm),
      centripetal_share_(control.centripetal_share),
      junction_share_(control.junction_share) {
  speed_.fill(kUnlimited);
  acceleration_.fill(kUnlimited);
  jerk_.fill(kUnlimited);
  axes_ = std::clamp<std::size_t>(axes.size(), 3, kMaxAxes);
  const bool soft = control.acceleration_mode == kernel::machine::AccelerationMode::soft;
  double largest_linear = 0.0;
  for (std::size_t i = 0; i < std::min(axes.size(), kMaxAxes); ++i) {
    const auto& axis = axes[i];
    speed_[i] = axis.max_speed_au_s;
    acceleration_[i] = axis.max_acceleration_au_s2;
    jerk_[i] = soft ? axis.max_jerk_au_s3 : kUnlimited;
    // One averaging window serves all axes. A window of A_i/J_i makes a step of the acceleration to
    // A_i rise at J_i, so the longest window keeps every axis within its jerk.
    if (std::isfinite(jerk_[i])) {
      jerk_time_s_ = std::max(jerk_time_s_, acceleration_[i] / jerk_[i]);
    }
    if (!axis.rotary) {
      largest_linear = std::max(largest_linear, acceleration_[i]);
    }
  }
  if (soft && std::isfinite(control.max_path_jerk_mm_s3)) {
    // Along a space diagonal three axes together give √3 times the acceleration of one.
    const double most = std::min(path_acceleration_mm_s2_, std::sqrt(3.0) * largest_linear);
    jerk_time_s_ = std::max(jerk_time_s_, most / control.max_path_jerk_mm_s3);
  }
}

// v·|t_i| ≤ V_i and a·|t_i| ≤ A_i for every axis that takes part; the tightest quotient counts.
// Rounding leaves shares of 1e-16 on axes that do not move: they must not count.
SpeedLimits PathLimits::line(const AxisValues& direction) const noexcept {
  SpeedLimits out{kUnlimited, path_acceleration_mm_s2_};
  for (std::size_t i = 0; i < axes_; ++i) {
    const double share = std::abs(direction[i]);
    if (share > 1e-12) {
      out.speed_mm_s = std::min(out.speed_mm_s, speed_[i] / share);
      out.acceleration_mm_s2 = std::min(out.acceleration_mm_s2, acceleration_[i] / share);
    }
  }
  return out;
}

// Over all unit vectors t perpendicular to n the largest |t_i| is √(1 − n_i²). The bound therefore
// holds on every sector of a circle but is too strict for a short arc that never points along the
// slow axis. It depends only on the plane, which makes it cheap for corners.
PlaneLimits PathLimits::plane(const Point& normal) const noexcept {
  PlaneLimits out{path_acceleration_mm_s2_, kUnlimited, kUnlimited};
  for (std::size_t i = 0; i < 3; ++i) {
    const double share = std::sqrt(std::max(0.0, 1.0 - normal[i] * normal[i]));
    if (share > 1e-9) {
      out.acceleration_mm_s2 = std::min(out.acceleration_mm_s2, acceleration_[i] / share);
      out.jerk_mm_s3 = std::min(out.jerk_mm_s3, jerk_[i] / share);
    }
    if (share > 1e-12) {
      out.speed_mm_s = std::min(out.speed_mm_s, speed_[i] / share);
    }
  }
  return out;
}

SpeedLimits PathLimits::circle(double radius_mm, const PlaneLimits& plane) const noexcept {
  const double radius = std::max(1e-9, radius_mm);
  // The plane's acceleration is one vector: κ_n of it may act across the path, v²/R ≤ κ_n·a; by
  // Pythagoras the rest may change the speed along the path.
  const double total = plane.acceleration_mm_s2;
  double v = std::min(std::sqrt(centripetal_share_ * total * radius), plane.speed_mm_s);
  if (std::isfinite(plane.jerk_mm_s3)) {  // a circle's own jerk is v³/R²
    v = std::min(v, std::cbrt(plane.jerk_mm_s3 * radius * radius));
  }
  const double normal = v * v / radius;
  return {v, std::sqrt(std::max(0.0, total * total - normal * normal))};
}

// Helices, spirals and arcs with further axes share the speed between the plane and the other axes.
// Radius and slope vary on a spiral, so each share is taken where it is largest: the plane's at the
// wide end, the other axes' at the tight end, where a radian is the shortest path.
SpeedLimits PathLimits::arc(const PathSegment& s) const noexcept {
  const double dr = s.radius_end_mm - s.radius_mm;
  const double tight = std::max(1e-9, std::min(s.radius_mm, s.radius_end_mm));
  const double wide = std::max(s.radius_mm, s.radius_end_mm);
  if (dr == 0.0 && s.rise_mm == 0.0 && s.other_start == s.other_end) {
    return circle(tight, plane(s.axis));
  }
  // Shares of one mm of path: in the plane and along the other axes, each at its largest.
  const double around_mm = wide * s.sweep_rad;
  const double slope = std::max(1e-12, std::hypot(dr, s.rise_mm, around_mm));
  const double plane_share = std::min(1.0, std::hypot(dr, around_mm) / slope);
  SpeedLimits straight = {kUnlimited, kUnlimited};
  SpeedLimits out = {kUnlimited, plane(s.axis).acceleration_mm_s2};
  const double least_slope = std::max(1e-12, std::hypot(dr, s.rise_mm, tight * s.sweep_rad));
  double jerk = kUnlimited;
  // An axis may see both parts at once (a turned plane); |around| + |along| bounds their sum at
  // every angle.
  for (std::size_t i = 0; i < axes_; ++i) {
    double around = 0.0;
    double along = 0.0;
    if (i < 3) {
      around = std::sqrt(std::max(0.0, 1.0 - s.axis[i] * s.axis[i])) * plane_share;
      along = std::abs(s.rise_mm * s.axis[i]) / least_slope;
      if (around > 1e-9) {
        jerk = std::min(jerk, jerk_[i] / around);
      }
    } else {
      along = std::abs(s.other_end[i - 3] - s.other_start[i - 3]) / least_slope;
    }
    if (around + along > 1e-12) {
      straight.speed_mm_s = std::min(straight.speed_mm_s, speed_[i] / (around + along));
    }
    // Without a part along the axis, a_plane already bounds its acceleration.
    if (along > 1e-12) {
      straight.acceleration_mm_s2 =
          std::min(straight.acceleration_mm_s2, acceleration_[i] / (around + along));
    }
  }
  // Only plane_share of the speed runs round the circle: centripetal v²·share²/R = v²/R_eff.
  const double radius_eff = tight / (plane_share * plane_share);
  const double total = out.acceleration_mm_s2;
  double v = std::sqrt(centripetal_share_ * total * radius_eff);
  v = std::min(v, straight.speed_mm_s);
  if (std::isfinite(jerk)) {  // a circle's own jerk is v³/R²
    v = std::min(v, std::cbrt(jerk * radius_eff * radius_eff));
  }
  const double normal = v * v / radius_eff;
  out.speed_mm_s = v;
  out.acceleration_mm_s2 = std::min(straight.acceleration_mm_s2,
                                    std::sqrt(std::max(0.0, total * total - normal * normal)));
  return out;
}

double PathLimits::kink(const AxisValues& before, const AxisValues& after, double speed_mm_s,
                        double ramp_mm_s2) const noexcept {
  const double at_once_mm_s2 = speed_mm_s / period_s_ + ramp_mm_s2;
  double most = 0.0;
  for (std::size_t i = 0; i < axes_; ++i) {
    most = std::max(most, std::abs(after[i] - before[i]) * at_once_mm_s2 / acceleration_[i]);
  }
  return most;
}

// Three laws, see the header. Axes that do not change direction do not count.
// jump: one period T changes an axis' velocity by A_i·T at most.
// deviation: a circle tangential to both legs at distance δ from the corner has R = δ·sin β/(1 −
// sin β), and v² = a·R. It is a law of lengths in space, so rotary axes do not count.
// facets: a curve of radius R in steps of ℓ turns by ℓ/R at each, so A/|Δt|·ℓ = A·R, the curve's
// own centripetal limit. Without it fine facets would run faster than the curve they replace, since
// each jump is small.
double PathLimits::junction_mm_s(const AxisValues& before, const AxisValues& after,
                                 double length_before_mm, double length_after_mm) const noexcept {
  double jump = kUnlimited;
  double least_a = path_acceleration_mm_s2_;
  double facets_a = kUnlimited;
  double dot = 0.0;
  double norm_before = 0.0;
  double norm_after = 0.0;
  for (std::size_t i = 0; i < axes_; ++i) {
    const double delta = std::abs(after[i] - before[i]);
    if (delta > 1e-9) {
      jump = std::min(jump, acceleration_[i] * period_s_ / delta);
      facets_a = std::min(facets_a, acceleration_[i] / delta);
    }
    if (i < 3) {
      least_a = delta > 1e-9 ? std::min(least_a, acceleration_[i]) : least_a;
      dot += before[i] * after[i];
      norm_before += before[i] * before[i];
      norm_after += after[i] * after[i];
    }
  }
  if (jump == kUnlimited) {
    return kUnlimited;
  }
  double deviation = 0.0;
  if (deviation_mm_ > 0.0 && norm_before > 0.0 && norm_after > 0.0 && std::isfinite(least_a)) {
    // sin β = cos(φ/2) = √((1 + cos φ)/2) with the turn φ = π − 2β.
    const double cos_turn = std::clamp(dot / std::sqrt(norm_before * norm_after), -1.0, 1.0);
    const double sin_half =
        std::sqrt(0.5 * (1.0 + cos_turn));  // sine of half the angle between the legs
    deviation = std::sqrt(least_a * deviation_mm_ * sin_half / std::max(1e-12, 1.0 - sin_half));
  }
  const double facets = std::sqrt(facets_a * 0.5 * (length_before_mm + length_after_mm));
  return std::min(facets, std::max(jump, deviation));
}

}  // namespace steadyrest::nc::plan
