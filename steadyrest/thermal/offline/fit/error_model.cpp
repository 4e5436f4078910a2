// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <cmath>
#include <numeric>
#include <vector>

#include <steadyrest/thermal/offline/fit/error_model.hpp>

namespace steadyrest::thermal::offline {

// Drift is a first-order process, covariance drift²·e^(−|t|/τ), under white noise. A scalar Kalman
// filter over each column turns it into innovations of unit variance: the same as multiplying by
// the inverse Cholesky factor of the covariance, in n steps instead of n³. log_sum is its log det.
double whiten(const ErrorModel& model, std::span<const double> time_s,
              std::span<const std::size_t> fresh, Eigen::MatrixXd& columns) {
  const double drift = model.drift_um * model.drift_um;
  const double noise = model.noise_um * model.noise_um;
  double variance = drift;
  double log_sum = 0.0;
  auto next_fresh = fresh.begin();
  Eigen::RowVectorXd expected = Eigen::RowVectorXd::Zero(columns.cols());
  for (Eigen::Index k = 0; k < columns.rows(); ++k) {
    const auto row = static_cast<std::size_t>(k);
    while (next_fresh != fresh.end() && *next_fresh < row) {
      ++next_fresh;
    }
    // After a gap the drift is unknown again: its stationary variance, expectation 0.
    if (row == 0 || (next_fresh != fresh.end() && *next_fresh == row)) {
      expected.setZero();
      variance = drift;
    } else {
      const double keep = std::exp(-(time_s[row] - time_s[row - 1]) / model.tau_s);
      expected *= keep;
      variance = keep * keep * variance + (1.0 - keep * keep) * drift;
    }
    const double s = variance + noise;
    const double gain = variance / s;
    const Eigen::RowVectorXd innovation = columns.row(k) - expected;
    expected += gain * innovation;
    variance *= 1.0 - gain;
    columns.row(k) = innovation / std::sqrt(s);
    log_sum += std::log(s);
  }
  return log_sum;
}

// Second differences cancel any drift that is linear over three rows; the median ignores spikes and
// the few rows where the machine really bends.
double noise_of(std::span<const double> time_s, std::span<const double> reading) {
  std::vector<double> second;
  for (std::size_t i = 2; i < reading.size(); ++i) {
    const double before = time_s[i - 1] - time_s[i - 2];
    const double after = time_s[i] - time_s[i - 1];
    const double d = std::abs(reading[i] - 2.0 * reading[i - 1] + reading[i - 2]);
    if (std::isfinite(d) && std::abs(after - before) < 0.1 * before) {
      second.push_back(d);
    }
  }
  if (second.empty()) {
    return 0.0;
  }
  const auto middle = second.begin() + static_cast<std::ptrdiff_t>(second.size() / 2);
  std::ranges::nth_element(second, middle);
  const double median = *middle;
  // Half of a normal distribution lies within 0.6745 of its RMS; 1 + 4 + 1 readings are summed.
  return median / 0.6745 / std::sqrt(6.0);
}

}  // namespace steadyrest::thermal::offline
