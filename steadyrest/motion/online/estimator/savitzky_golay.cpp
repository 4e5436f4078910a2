// SPDX-License-Identifier: Apache-2.0
#include <Eigen/Dense>

#include <steadyrest/motion/online/estimator/refusal.hpp>
#include <steadyrest/motion/online/estimator/savitzky_golay.hpp>

namespace steadyrest::motion::online {

kernel::outcome::Result<SavitzkyGolay> SavitzkyGolay::make(const Config& config) {
  if (!(config.count_mm > 0.0) || !(config.cycle_s > 0.0)) {
    return std::unexpected(refuse_config("count and cycle of the filter must be positive"));
  }
  if (config.degree < 1 || config.degree > kMaxDegree) {
    return std::unexpected(refuse_config("degree of the filter is not within 1…4"));
  }
  if (config.samples < config.degree + 1 || config.samples > kMaxSamples) {
    return std::unexpected(refuse_config("samples of the filter are not within degree + 1…128"));
  }
  return SavitzkyGolay(config);
}

SavitzkyGolay::SavitzkyGolay(const Config& config) : config_(config) {
  const auto n = static_cast<Eigen::Index>(config.samples);
  const auto terms = static_cast<Eigen::Index>(config.degree + 1);
  const auto span_ticks = static_cast<double>(n - 1);  // time scaled to −1…0
  Eigen::MatrixXd powers(n, terms);
  for (Eigen::Index j = 0; j < n; ++j) {
    powers(j, 0) = 1.0;
    for (Eigen::Index i = 1; i < terms; ++i) {
      powers(j, i) = powers(j, i - 1) * (-static_cast<double>(j) / span_ticks);
    }
  }
  const Eigen::MatrixXd fit = powers.householderQr().solve(Eigen::MatrixXd::Identity(n, n));
  const double span_s = span_ticks * config.cycle_s;
  for (std::size_t j = 0; j < config.samples; ++j) {
    const auto column = static_cast<Eigen::Index>(j);
    position_[j] = fit(0, column);
    velocity_[j] = fit(1, column) / span_s;
    acceleration_[j] = terms > 2 ? 2.0 * fit(2, column) / (span_s * span_s) : 0.0;
  }
}

Estimate SavitzkyGolay::tick(const Tick& tick) noexcept {
  const std::size_t n = config_.samples;
  if (!started_) {
    counts_.fill(tick.count);  // as if the axis had always been at rest here
    started_ = true;
  }
  newest_ = (newest_ + 1) % n;
  counts_[newest_] = tick.count;
  double x = 0.0;
  double v = 0.0;
  double a = 0.0;
  for (std::size_t j = 0; j < n; ++j) {
    // Relative to the newest count: large counts keep their digits.
    const auto back = static_cast<double>(counts_[(newest_ + n - j) % n] - tick.count);
    x += position_[j] * back;
    v += velocity_[j] * back;
    a += acceleration_[j] * back;
  }
  Estimate out;
  out.t_s = tick.t_s;
  out.position_mm = 0.5 * (tick.low_mm + tick.high_mm) + x * config_.count_mm;
  out.velocity_mm_s = v * config_.count_mm;
  out.acceleration_mm_s2 = a * config_.count_mm;
  return out;
}

}  // namespace steadyrest::motion::online
