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

PathLimits::PathLimits(const kernel::machine::Machine& machine)
    : path_acceleration_mm_s2_(machine.control.max_path_acceleration_mm_s2),
      period_s_(machine.control.interpolator_period_s),
      deviation_mm_(machine.control.junction_deviation_mm),
      centripetal_share_(machine.control.centripetal_share),
      junction_share_(machine.control.junction_share) {
  speed_.fill(kUnlimited);
  acceleration_.fill(kUnlimited);
  jerk_.fill(kUnlimited);
  axes_ = std::clamp<std::size_t>(machine.axes.size(), 3, kMaxAxes);
  double largest_linear = 0.0;
  for (std::size_t i = 0; i < std::min(machine.axes.size(), kMaxAxes); ++i) {
    const auto& axis = machine.axes[i];
    speed_[i] = axis.max_speed_mm_s;
    acceleration_[i] = axis.max_acceleration_mm_s2;
    jerk_[i] = axis.max_jerk_mm_s3;
    if (std::isfinite(jerk_[i])) {
      jerk_time_s_ = std::max(jerk_time_s_, acceleration_[i] / jerk_[i]);
    }
    if (!axis.rotary) {
      largest_linear = std::max(largest_linear, acceleration_[i]);
    }
  }
  if (std::isfinite(machine.control.max_path_jerk_mm_s3)) {
    // Along a space diagonal three axes together give √3 times the acceleration of one.
    const double most = std::min(path_acceleration_mm_s2_, std::sqrt(3.0) * largest_linear);
    jerk_time_s_ = std::max(jerk_time_s_, most / machine.control.max_path_jerk_mm_s3);
  }
}

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
  const double total = plane.acceleration_mm_s2;
  double v = std::min(std::sqrt(centripetal_share_ * total * radius), plane.speed_mm_s);
  if (std::isfinite(plane.jerk_mm_s3)) {  // a circle's own jerk is v³/R²
    v = std::min(v, std::cbrt(plane.jerk_mm_s3 * radius * radius));
  }
  const double normal = v * v / radius;
  return {v, std::sqrt(std::max(0.0, total * total - normal * normal))};
}

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
    if (along > 1e-12) {
      straight.acceleration_mm_s2 =
          std::min(straight.acceleration_mm_s2, acceleration_[i] / (around + along));
    }
  }
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

double PathLimits::junction_use(const AxisValues& before, const AxisValues& after,
                                double speed_mm_s) const noexcept {
  if (junction_share_ >= 1.0) {
    return 0.0;
  }
  double use = 0.0;
  for (std::size_t i = 0; i < axes_; ++i) {
    use =
        std::max(use, std::abs(after[i] - before[i]) * speed_mm_s / (acceleration_[i] * period_s_));
  }
  return std::min(use, junction_share_);
}

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
      jump = std::min(jump, junction_share_ * acceleration_[i] * period_s_ / delta);
      facets_a = std::min(facets_a, acceleration_[i] / delta);
      least_a = std::min(least_a, acceleration_[i]);
    }
    if (i < 3) {
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
    const double cos_turn = std::clamp(dot / std::sqrt(norm_before * norm_after), -1.0, 1.0);
    const double sin_half =
        std::sqrt(0.5 * (1.0 + cos_turn));  // sine of half the angle between the legs
    deviation = std::sqrt(least_a * deviation_mm_ * sin_half / std::max(1e-12, 1.0 - sin_half));
  }
  const double facets = std::sqrt(facets_a * 0.5 * (length_before_mm + length_after_mm));
  return std::min(facets, std::max(jump, deviation));
}

}  // namespace steadyrest::nc::plan
