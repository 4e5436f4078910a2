// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <cmath>

#include <steadyrest/motion/online/estimator/refusal.hpp>
#include <steadyrest/motion/online/estimator/worst_case_difference.hpp>

namespace steadyrest::motion::online {

kernel::outcome::Result<WorstCaseDifference> WorstCaseDifference::make(const Config& config) {
  const bool positive = config.count_mm > 0.0 && config.cycle_s > 0.0 &&
                        config.max_acceleration_mm_s2 > 0.0 && config.line_error_mm >= 0.0;
  if (!positive || !std::isfinite(config.max_acceleration_mm_s2)) {
    return std::unexpected(
        refuse_config("count, cycle or limit of acceleration is not positive and finite"));
  }
  return WorstCaseDifference(config);
}

WorstCaseDifference::WorstCaseDifference(const Config& config) noexcept
    : config_(config), noise_mm_(0.5 * config.count_mm + config.line_error_mm) {
  const double limit = config.max_acceleration_mm_s2;
  // 2N̄/W from position, L·W from the path's curvature over the window; half of it for a single
  // tick. The window that minimises the sum is the longest worth using.
  const auto bound = [&](std::size_t ticks) {
    const double window_s = static_cast<double>(ticks) * config.cycle_s;
    return 2.0 * noise_mm_ / window_s + limit * window_s * (ticks > 1 ? 1.0 : 0.5);
  };
  for (std::size_t ticks = 2; ticks <= kMaxTicks; ++ticks) {
    longest_ = bound(ticks) < bound(longest_) ? ticks : longest_;
  }
}

// N̂ of the paper: the smallest position error that explains the record under the limit L.
double WorstCaseDifference::shown_error_mm(std::size_t longest) const noexcept {
  const Sample& now = back(0);
  const double limit = config_.max_acceleration_mm_s2;
  double most = 0.0;
  for (std::size_t l = 2; l <= longest; ++l) {
    const double window_s = now.t_s - back(l).t_s;
    const double slope = (now.x_mm - back(l).x_mm) / window_s;
    for (std::size_t j = 1; j < l; ++j) {
      const double age_s = now.t_s - back(j).t_s;
      const double off_chord = std::abs(back(j).x_mm - now.x_mm + slope * age_s);
      // A sample's distance from the chord beyond what acceleration L could bend the path must be
      // position error.
      most = std::max(most, off_chord - 0.5 * limit * age_s * (window_s - age_s));
    }
  }
  // Sample and chord may each be off by half of it.
  return 0.5 * most;
}

Estimate WorstCaseDifference::tick(const Tick& tick) noexcept {
  Estimate out;
  out.t_s = tick.t_s;
  out.position_mm = 0.5 * (tick.low_mm + tick.high_mm);
  out.position_bound_mm = noise_mm_;
  if (known_ > 0 && !(tick.t_s > back(0).t_s)) {
    known_ = 0;  // time stopped or went back: start over
  }
  newest_ = (newest_ + 1) % samples_.size();
  samples_[newest_] = {tick.t_s, out.position_mm, 0.0};
  known_ = std::min(known_ + 1, samples_.size());
  if (known_ < 2) {
    return out;
  }
  const double limit = config_.max_acceleration_mm_s2;
  const std::size_t longest = std::min(longest_, known_ - 1);
  // w ≥ 2√(N̂/L): the window at which the two error terms balance for the error shown.
  const double wanted_s = 2.0 * std::sqrt(shown_error_mm(longest) / limit);
  std::size_t window = 1;
  while (window < longest && tick.t_s - back(window).t_s < wanted_s) {
    ++window;
  }
  const Sample& start = back(window);
  out.velocity_mm_s = (out.position_mm - start.x_mm) / (tick.t_s - start.t_s);
  samples_[newest_].v_mm_s = out.velocity_mm_s;

  const Sample& oldest = back(longest);
  const double span_s = tick.t_s - oldest.t_s;
  out.velocity_bound_mm_s = 2.0 * noise_mm_ / span_s + limit * span_s * (longest > 1 ? 1.0 : 0.5);
  out.acceleration_mm_s2 = std::clamp((out.velocity_mm_s - oldest.v_mm_s) / span_s, -limit, limit);
  // The true acceleration is within ±L, whatever the estimate.
  out.acceleration_bound_mm_s2 = std::abs(out.acceleration_mm_s2) + limit;
  return out;
}

}  // namespace steadyrest::motion::online
