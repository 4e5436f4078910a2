// SPDX-License-Identifier: Apache-2.0
#include <cmath>

#include <steadyrest/motion/online/estimator/pll.hpp>
#include <steadyrest/motion/online/estimator/refusal.hpp>

namespace steadyrest::motion::online {

kernel::outcome::Result<Pll> Pll::make(const Config& config) {
  if (!(config.count_mm > 0.0) || !(config.cycle_s > 0.0)) {
    return std::unexpected(refuse_config("count and cycle of the loop must be positive"));
  }
  if (!(config.bandwidth_rad_s > 0.0) || !(2.0 * config.bandwidth_rad_s * config.cycle_s < 1.0)) {
    return std::unexpected(refuse_config("bandwidth of the loop is not within 0…1/(2·cycle)"));
  }
  return Pll(config);
}

// Critically damped: kp = 2b, ki = kp²/4. Needs 2bT < 1, which make() checks.
Pll::Pll(const Config& config) noexcept
    : config_(config), kp_1_s_(2.0 * config.bandwidth_rad_s), ki_1_s2_(0.25 * kp_1_s_ * kp_1_s_) {}

Estimate Pll::tick(const Tick& tick) noexcept {
  if (!started_) {
    started_ = true;
    origin_ = tick.count;
    // Counts are cells; the axis is assumed to be in the middle of its first one.
    position_counts_ = 0.5;
  }
  const double period_s = config_.cycle_s;
  position_counts_ += period_s * velocity_counts_s_;
  const double whole = std::floor(position_counts_);
  const double delta = static_cast<double>(tick.count - origin_) - whole;
  position_counts_ += period_s * kp_1_s_ * delta;
  velocity_counts_s_ += period_s * ki_1_s2_ * delta;
  // Below half of one correction step the velocity would hunt about zero at rest.
  if (std::abs(velocity_counts_s_) < 0.5 * period_s * ki_1_s2_) {
    velocity_counts_s_ = 0.0;
  }
  Estimate out;
  out.t_s = tick.t_s;
  out.position_mm = (static_cast<double>(origin_) + position_counts_) * config_.count_mm;
  out.velocity_mm_s = velocity_counts_s_ * config_.count_mm;
  out.acceleration_mm_s2 = ki_1_s2_ * delta * config_.count_mm;
  return out;
}

}  // namespace steadyrest::motion::online
