// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <cmath>
#include <numbers>

#include <steadyrest/sim/base/range.hpp>
#include <steadyrest/sim/panel/spindle_drive.hpp>

// Constant torque up to the base speed, constant power above it, solved in closed form piece by
// piece: the result does not depend on the period.
namespace steadyrest::sim {
namespace {

constexpr double kPi = std::numbers::pi;

/// Ramp and power limit of one drive, on the magnitude of the speed.
struct Ramp {
  double constant, base, power;

  /// Accelerates to a higher speed for at most `time_s`, which becomes the remaining time.
  [[nodiscard]] double rise(double from, double to, double& time_s) const noexcept {
    const double corner = std::min(to, base);
    if (from < corner) {
      const double needed = (corner - from) / constant;
      if (needed >= time_s) {
        from += constant * time_s;
        time_s = 0.0;
        return from;
      }
      time_s -= needed;
      from = corner;
    }
    if (from < to) {
      // At constant power n² rises evenly: d(n²)/dt = P/(2π²J).
      const double needed = (to * to - from * from) / power;
      if (needed >= time_s) {
        from = std::sqrt(from * from + power * time_s);
        time_s = 0.0;
        return from;
      }
      time_s -= needed;
    }
    return to;
  }

  // Braking is the run-up in reverse: the drive has the same torque and power either way.
  [[nodiscard]] double fall(double from, double to, double& time_s) const noexcept {
    const double corner = std::max(to, base);
    if (from > corner) {
      const double needed = (from * from - corner * corner) / power;
      if (needed >= time_s) {
        from = std::sqrt(std::max(corner * corner, from * from - power * time_s));
        time_s = 0.0;
        return from;
      }
      time_s -= needed;
      from = corner;
    }
    if (from > to) {
      const double needed = (from - to) / constant;
      if (needed >= time_s) {
        from -= constant * time_s;
        time_s = 0.0;
        return from;
      }
      time_s -= needed;
    }
    return to;
  }
};

}  // namespace

kernel::outcome::Result<SpindleDrive> SpindleDrive::make(const Config& config) {
  constexpr double kMax = kernel::machine::kUnlimited;
  const kernel::machine::Spindle& s = config.spindle;
  if (auto ok = in_range(
          "spindle", {{"max_rev_s", s.max_rev_s, 1e-6, 1e5},
                      {"min_rev_s", s.min_rev_s, 0.0, s.max_rev_s},
                      {"acceleration_rev_s2", s.acceleration_rev_s2, 1e-6, kMax},
                      {"inertia_kg_m2", s.inertia_kg_m2, 1e-9, 1e6},
                      {"rated_power_w", s.rated_power_w, 1e-3, 1e9},
                      {"max_torque_n_m", s.max_torque_n_m, 1e-6, 1e9},
                      {"at_speed_tolerance_ratio", config.at_speed_tolerance_ratio, 1e-6, 0.5}});
      !ok) {
    return std::unexpected(ok.error());
  }
  return SpindleDrive(config);
}

// M = J·2π·ṅ gives the ramp, P = M·2π·n the speed above which power is the limit: n_b =
// P/(4π²·J·ṅ). ½J(2πn)² gives d(n²)/dt = P/(2π²·J).
SpindleDrive::SpindleDrive(const Config& config) noexcept
    : min_rev_s_(config.spindle.min_rev_s),
      max_rev_s_(config.spindle.max_rev_s),
      ramp_rev_s2_(
          std::min(config.spindle.acceleration_rev_s2,
                   config.spindle.max_torque_n_m / (2.0 * kPi * config.spindle.inertia_kg_m2))),
      base_rev_s_(config.spindle.rated_power_w /
                  (4.0 * kPi * kPi * config.spindle.inertia_kg_m2 * ramp_rev_s2_)),
      power_rev2_s3_(config.spindle.rated_power_w /
                     (2.0 * kPi * kPi * config.spindle.inertia_kg_m2)),
      tolerance_(config.at_speed_tolerance_ratio) {}

double SpindleDrive::target(const Input& input) const noexcept {
  const double wanted = input.command_rev_s * std::max(0.0, input.override_ratio);
  if (wanted == 0.0 || !std::isfinite(wanted)) {
    return 0.0;
  }
  return std::copysign(std::clamp(std::abs(wanted), min_rev_s_, max_rev_s_), wanted);
}

SpindleDrive::Output SpindleDrive::update(const Input& input) noexcept {
  const Ramp ramp{.constant = ramp_rev_s2_, .base = base_rev_s_, .power = power_rev2_s3_};
  const double goal = target(input);
  double left_s = std::max(0.0, input.period_s);
  // A reversal brakes to zero first, then runs up for the rest of the period.
  if (actual_rev_s_ * goal < 0.0) {  // through zero first
    actual_rev_s_ = std::copysign(ramp.fall(std::abs(actual_rev_s_), 0.0, left_s), actual_rev_s_);
  }
  if (left_s > 0.0) {
    const double speed = std::abs(actual_rev_s_);
    const double wanted = std::abs(goal);
    const double sign = goal != 0.0 ? goal : actual_rev_s_;
    actual_rev_s_ = std::copysign(
        speed < wanted ? ramp.rise(speed, wanted, left_s) : ramp.fall(speed, wanted, left_s), sign);
  }
  return {.target_rev_s = goal,
          .actual_rev_s = actual_rev_s_,
          .at_speed = std::abs(actual_rev_s_ - goal) <= tolerance_ * std::max(1.0, std::abs(goal))};
}

}  // namespace steadyrest::sim
