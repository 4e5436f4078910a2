// SPDX-License-Identifier: Apache-2.0
// Against the dense covariance of drift and noise: whitening is a multiplication by L⁻¹.
#include <cmath>
#include <cstddef>
#include <random>
#include <vector>

#include <Eigen/Cholesky>
#include <gtest/gtest.h>

#include <steadyrest/thermal/offline/fit/error_model.hpp>

namespace steadyrest::thermal::offline {
namespace {

const ErrorModel kWander{.drift_um = 2.5, .tau_s = 1800.0, .noise_um = 0.4};

/// Uneven times, as thinned logs have them.
std::vector<double> uneven_times_s() {
  std::vector<double> out(40);
  for (std::size_t i = 0; i < out.size(); ++i) {
    const auto k = static_cast<double>(i);
    out[i] = 60.0 * k + 25.0 * std::sin(k * k) + (i > 20 ? 5000.0 : 0.0);
  }
  return out;
}

/// drift²·e^(−|t|/τ) within a stretch, nothing between stretches, and the noise on the diagonal.
Eigen::MatrixXd dense_covariance(const std::vector<double>& time_s, std::size_t fresh) {
  const auto n = static_cast<Eigen::Index>(time_s.size());
  Eigen::MatrixXd out = Eigen::MatrixXd::Zero(n, n);
  for (std::size_t i = 0; i < time_s.size(); ++i) {
    for (std::size_t k = 0; k < time_s.size(); ++k) {
      const auto row = static_cast<Eigen::Index>(i);
      const auto column = static_cast<Eigen::Index>(k);
      if ((i < fresh) == (k < fresh)) {
        out(row, column) = 6.25 * std::exp(-std::abs(time_s[i] - time_s[k]) / 1800.0);
      }
      out(row, column) += i == k ? 0.16 : 0.0;
    }
  }
  return out;
}

TEST(ErrorModel, WhitensAsTheInverseOfTheDenseCovariancesRoot) {
  const std::vector<double> time_s = uneven_times_s();
  // All in one stretch, and with the drift new at row 13.
  for (const std::size_t fresh : {std::size_t{0}, std::size_t{13}}) {
    const std::vector<std::size_t> gaps(fresh > 0 ? 1 : 0, fresh);
    const Eigen::LLT<Eigen::MatrixXd> root(dense_covariance(time_s, fresh));
    Eigen::MatrixXd columns(40, 2);
    for (Eigen::Index i = 0; i < 40; ++i) {
      columns.row(i) << 1.0, std::cos(0.7 * static_cast<double>(i));
    }
    const Eigen::MatrixXd want = root.matrixL().solve(columns);
    const double log_sum = whiten(kWander, time_s, gaps, columns);
    EXPECT_LT((columns - want).cwiseAbs().maxCoeff(), 1e-10) << fresh;
    const Eigen::MatrixXd l = root.matrixL();
    EXPECT_NEAR(log_sum, 2.0 * l.diagonal().array().log().sum(), 1e-9) << "ln det";
  }
}

TEST(ErrorModel, WithoutDriftOnlyScalesByTheNoise) {
  const std::vector<double> time_s = uneven_times_s();
  Eigen::MatrixXd columns = Eigen::MatrixXd::Constant(40, 1, 3.0);
  const ErrorModel noise{.drift_um = 0.0, .tau_s = 1800.0, .noise_um = 0.5};
  EXPECT_NEAR(whiten(noise, time_s, {}, columns), 40.0 * std::log(0.25), 1e-12);
  EXPECT_LT((columns.array() - 6.0).abs().maxCoeff(), 1e-12);
}

// A strong slow motion beneath does not count, nor do a few spikes and rows beside a hole.
TEST(NoiseOf, IsThatOfTheReadingsAndNotOfTheMotionBeneath) {
  std::mt19937 random(6);
  std::normal_distribution<double> normal(0.0, 0.3);
  std::vector<double> time_s;
  std::vector<double> reading;
  for (int i = 0; i < 4000; ++i) {
    time_s.push_back(10.0 * i + (i >= 2000 ? 900.0 : 0.0));
    reading.push_back(80.0 * std::exp(-time_s.back() / 9000.0) + normal(random) +
                      (i % 400 == 77 ? 50.0 : 0.0) + (i >= 2000 ? 1000.0 : 0.0));
  }
  EXPECT_NEAR(noise_of(time_s, reading), 0.3, 0.3 * 0.06);
  EXPECT_EQ(noise_of(std::vector{0.0, 1.0}, std::vector{3.0, 9.0}), 0.0) << "two show nothing";
}

}  // namespace
}  // namespace steadyrest::thermal::offline
