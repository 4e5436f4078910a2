// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <cmath>
#include <numbers>

#include <steadyrest/chatter/offline/process/speed_profile.hpp>
#include <steadyrest/kernel/units/constants.hpp>

// The solver needs the speed over the angle; a law gives it over time. With u the phase of the law,
// θ(u) = P·(u + RVA·∫S), P the angle of one period; phase() inverts it. A course of ramps needs no
// inversion: on each ramp Ω² is linear in the angle.
namespace steadyrest::chatter::offline {

namespace {

using kernel::units::kTurn;

constexpr int kMostNewtonSteps = 80;
constexpr double kPhaseRounding = 4e-16;  ///< of a phase: closer than this the steps only wander
constexpr std::size_t kMostCorners = 64;
}  // namespace

SpeedProfile::SpeedProfile(double mean_rev_s, const Modulation& modulation)
    : law_(modulation.law, modulation.seed),
      mean_rad_s_(kTurn * mean_rev_s),
      rva_(modulation.rva),
      slowest_rad_s_(mean_rad_s_),
      constant_(modulation.law == online::Law::constant || modulation.rva == 0.0) {
  if (constant_) {
    return;
  }
  period_rad_ = kTurn / modulation.rvf;
  slowest_rad_s_ *= 1.0 - rva_;
  for (std::size_t k = 0; k < law_.corner_count(); ++k) {
    const double u = law_.corners()[k];
    // A corner in time is a corner in angle, at θ(u).
    corners_rad_.push_back(period_rad_ * (u + rva_ * law_.integral(u)));
  }
}

double SpeedProfile::angle_rad(const std::vector<SpeedRamp>& course) noexcept {
  double out = 0.0;
  // Mean speed of the ramp times its duration: 2π·(n₀ + n₁)/2·t.
  for (const SpeedRamp& ramp : course) {
    out += std::numbers::pi * (ramp.from_rev_s + ramp.to_rev_s) * ramp.duration_s;
  }
  return out;
}

SpeedProfile::SpeedProfile(const std::vector<SpeedRamp>& course, double period_rad)
    : mean_rad_s_(0.0),
      rva_(0.0),
      slowest_rad_s_(kTurn * course.front().from_rev_s),
      period_rad_(period_rad),
      constant_(false) {
  // Stretched in time, not in speed: the speeds are the machine's own.
  const double stretch = period_rad / angle_rad(course);
  Part next{0.0, 0.0, 0.0, 0.0};
  for (const SpeedRamp& ramp : course) {
    next.from_rad_s = kTurn * ramp.from_rev_s;
    next.to_rad_s = kTurn * ramp.to_rev_s;
    parts_.push_back(next);
    slowest_rad_s_ = std::min({slowest_rad_s_, next.from_rad_s, next.to_rad_s});
    next.time_s += stretch * ramp.duration_s;
    next.angle_rad += 0.5 * (next.from_rad_s + next.to_rad_s) * stretch * ramp.duration_s;
  }
  next.angle_rad = period_rad;
  parts_.push_back(next);
  mean_rad_s_ = period_rad / next.time_s;
  // Each corner begins a new piece in the solver; hundreds of stairs would cost more than their
  // kinks matter.
  for (std::size_t k = 0; course.size() <= kMostCorners && k < course.size(); ++k) {
    corners_rad_.push_back(parts_[k].angle_rad);
  }
}

const SpeedProfile::Part& SpeedProfile::part(double angle_rad) const noexcept {
  const auto above = std::ranges::upper_bound(parts_, angle_rad, {}, &Part::angle_rad);
  const auto at = std::clamp<std::ptrdiff_t>(above - parts_.begin() - 1, 0,
                                             static_cast<std::ptrdiff_t>(parts_.size()) - 2);
  return parts_[static_cast<std::size_t>(at)];
}

/// θ(u) rises: Newton's steps, halved into the bracket when they leave it.
double SpeedProfile::phase(double angle_rad) const noexcept {
  const double want = angle_rad / period_rad_;
  double low = 0.0;
  double high = 1.0;
  double u = want;
  for (int i = 0; i < kMostNewtonSteps && high - low > kPhaseRounding; ++i) {
    const double off = u + rva_ * law_.integral(u) - want;
    (off > 0.0 ? high : low) = u;
    double next = u - off / (1.0 + rva_ * law_.at(u));
    // At a jump of the law a Newton step may leave the bracket; halving cannot.
    if (!(next > low && next < high)) {
      next = 0.5 * (low + high);
    }
    const double step = std::abs(next - u);
    u = next;
    if (step < kPhaseRounding) {
      break;
    }
  }
  return u;
}

double SpeedProfile::speed_rad_s(double angle_rad) const noexcept {
  if (constant_) {
    return mean_rad_s_;
  }
  const double within = angle_rad - std::floor(angle_rad / period_rad_) * period_rad_;
  if (!parts_.empty()) {
    const Part& at = part(within);
    const double length = (&at)[1].angle_rad - at.angle_rad;
    // Even acceleration in time: Ω² is linear in the angle.
    return std::sqrt(std::lerp(at.from_rad_s * at.from_rad_s, at.to_rad_s * at.to_rad_s,
                               std::clamp((within - at.angle_rad) / length, 0.0, 1.0)));
  }
  return mean_rad_s_ * (1.0 + rva_ * law_.at(phase(within)));
}

double SpeedProfile::time_s(double angle_rad) const noexcept {
  if (constant_) {
    return angle_rad / mean_rad_s_;
  }
  const double periods = std::floor(angle_rad / period_rad_);
  if (!parts_.empty()) {
    const double within = angle_rad - periods * period_rad_;
    const Part& at = part(within);
    // Angle over the mean speed, which on a ramp is the mean of its ends.
    return periods * parts_.back().time_s + at.time_s +
           2.0 * (within - at.angle_rad) / (at.from_rad_s + speed_rad_s(within));
  }
  return (periods + phase(angle_rad - periods * period_rad_)) * period_rad_ / mean_rad_s_;
}

}  // namespace steadyrest::chatter::offline
