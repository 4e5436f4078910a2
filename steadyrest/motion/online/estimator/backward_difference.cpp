// SPDX-License-Identifier: Apache-2.0
#include <steadyrest/motion/online/estimator/backward_difference.hpp>
#include <steadyrest/motion/online/estimator/refusal.hpp>

namespace steadyrest::motion::online {

kernel::outcome::Result<BackwardDifference> BackwardDifference::make(const Config& config) {
  if (!(config.count_mm > 0.0) || !(config.cycle_s > 0.0)) {
    return std::unexpected(refuse_config("count and cycle of the difference must be positive"));
  }
  if (config.ticks < 1 || config.ticks > kMaxTicks) {
    return std::unexpected(refuse_config("ticks of the difference are not within 1…64"));
  }
  return BackwardDifference(config);
}

std::int64_t BackwardDifference::count_before(std::size_t ticks) const noexcept {
  return counts_[(newest_ + counts_.size() - ticks) % counts_.size()];
}

Estimate BackwardDifference::tick(const Tick& tick) noexcept {
  if (!started_) {
    counts_.fill(tick.count);  // as if the axis had always been at rest here
    started_ = true;
  }
  newest_ = (newest_ + 1) % counts_.size();
  counts_[newest_] = tick.count;
  // Velocity: q·(c_k − c_{k−m})/(mT), lag mT/2. Acceleration: the second difference over the same
  // m, lag mT. T is the nominal period, so jitter of the cycle shows in both.
  const std::size_t m = config_.ticks;
  const double span_s = static_cast<double>(m) * config_.cycle_s;
  const std::int64_t last = tick.count - count_before(m);
  const std::int64_t before = count_before(m) - count_before(2 * m);
  Estimate out;
  out.t_s = tick.t_s;
  out.position_mm = 0.5 * (tick.low_mm + tick.high_mm);
  out.position_bound_mm = 0.5 * (tick.high_mm - tick.low_mm);
  out.velocity_mm_s = config_.count_mm * static_cast<double>(last) / span_s;
  out.acceleration_mm_s2 =
      config_.count_mm * static_cast<double>(last - before) / (span_s * span_s);
  return out;
}

}  // namespace steadyrest::motion::online
