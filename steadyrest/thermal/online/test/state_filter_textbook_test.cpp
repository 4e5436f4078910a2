// SPDX-License-Identifier: Apache-2.0
#include <cmath>
#include <random>

#include <Eigen/Dense>
#include <gtest/gtest.h>
#include <unsupported/Eigen/MatrixFunctions>

#include <steadyrest/thermal/online/state_filter.hpp>
#include <steadyrest/thermal/online/test/turning.hpp>
#include <steadyrest/thermal/online/test/two_modes.hpp>

namespace steadyrest::thermal::online {
namespace {

using test::made;
using test::turning;
using test::two_modes;

/// The textbook's filter on the continuous system: transition by matrix exponential, noise by Van
/// Loan's block matrix, Joseph's update.
class Dense {
 public:
  Dense(const StateFilter::Config& config, double drift_mm, double walk_mm_sqrt_s)
      : config_(config), drift_mm_(drift_mm), walk_(walk_mm_sqrt_s) {
    x(3) = 1.0;
    // States in the order mode, mode, bias, scale; the scale begins at 1.
    p(2, 2) = config.start_sd_mm * config.start_sd_mm;
    p(3, 3) = config.gain_sd_ratio * config.gain_sd_ratio;
  }

  void step(double h, const std::array<double, 2>& level, const std::array<double, 2>& tau) {
    Eigen::Matrix4d f = Eigen::Matrix4d::Zero();
    for (std::size_t i = 0; i < 2; ++i) {
      const auto row = static_cast<Eigen::Index>(i);
      f(row, row) = -1.0 / tau[i];
      f(row, 3) = level[i] / tau[i];
    }
    Eigen::Matrix4d q = Eigen::Matrix4d::Zero();
    if (drift_mm_ > 0.0) {
      f(2, 2) = -1.0 / config_.axis.drift_tau_s;
      q(2, 2) = 2.0 * drift_mm_ * drift_mm_ / config_.axis.drift_tau_s;
    } else {
      q(2, 2) = walk_ * walk_;
    }
    Eigen::Matrix<double, 8, 8> block;
    block << -f, q, Eigen::Matrix4d::Zero(), f.transpose();
    const Eigen::Matrix<double, 8, 8> e = (block * h).exp();
    const Eigen::Matrix4d phi = e.bottomRightCorner<4, 4>().transpose();
    x = phi * x;
    p = phi * p * phi.transpose() + phi * e.topRightCorner<4, 4>();
  }

  void measure(double z, double sd) {
    const Eigen::RowVector4d h(1.0, 1.0, 1.0, 0.0);
    const double s = h * p * h.transpose() + sd * sd;
    const Eigen::Vector4d k = p * h.transpose() / s;
    x += k * (z - h * x);
    const Eigen::Matrix4d left = Eigen::Matrix4d::Identity() - k * h;
    p = left * p * left.transpose() + k * sd * sd * k.transpose();
  }

  [[nodiscard]] double sd() const { return std::sqrt(p.topLeftCorner<3, 3>().sum()); }
  Eigen::Vector4d x = Eigen::Vector4d::Zero();
  Eigen::Matrix4d p = Eigen::Matrix4d::Zero();

 private:
  StateFilter::Config config_;
  double drift_mm_;
  double walk_;
};

void expect_textbook(double drift_mm, unsigned seed) {
  StateFilter::Config config{.axis = two_modes(), .start_sd_mm = 0.002, .gate_sd = 100.0};
  config.axis.drift_mm = drift_mm;
  StateFilter filter = made(config);
  Dense dense(config, drift_mm, config.walk_mm_sqrt_s);
  std::mt19937 random(seed);
  std::uniform_real_distribution<double> unit(0.0, 1.0);
  std::normal_distribution<double> normal;
  for (int k = 0; k < 300; ++k) {
    const double speed = unit(random) < 0.3 ? 0.0 : 100.0 * unit(random);
    // From a second to most of an hour.
    const double h = std::exp(8.0 * unit(random));
    filter.update(h, turning(speed));
    const auto& m = config.axis.mode;
    dense.step(h, {m[0].level_mm[1] * speed / 100.0, m[1].level_mm[1] * speed / 100.0},
               {speed == 0.0 ? m[0].rest_tau_s : m[0].tau_s, m[1].tau_s});
    if (unit(random) < 0.4) {
      const double z = dense.x.head<3>().sum() + 0.001 * normal(random);
      filter.measure({.displacement_mm = z, .sd_mm = 0.0007});
      dense.measure(z, 0.0007);
    }
    // Two derivations of one filter agree to rounding; an error in the in-place covariance would
    // not.
    ASSERT_NEAR(filter.displacement_mm(), dense.x.head<3>().sum(), 1e-11) << k;
    ASSERT_NEAR(filter.sd_mm(), dense.sd(), 1e-9) << k;
    ASSERT_NEAR(filter.gain(), dense.x(3), 1e-9) << k;
    ASSERT_NEAR(filter.bias_mm(), dense.x(2), 1e-11) << k;
  }
}

TEST(StateFilter, IsTheTextbooksFilterOnTheContinuousSystem) {
  expect_textbook(0.003, 1);
  expect_textbook(0.0, 2);
}

// The scale starts at 1, so nothing is added to the model's own step.
TEST(StateFilter, WithoutReadingsIsTheModel) {
  StateFilter filter = made({.axis = two_modes()});
  auto model = ThermalModel::make(two_modes());
  ASSERT_TRUE(model);
  for (int k = 0; k < 100; ++k) {
    const Drive drive = turning(k % 7 == 0 ? 0.0 : 3.0 * k);
    EXPECT_NEAR(filter.update(37.0 * k, drive), model->update(37.0 * k, drive), 1e-15);
  }
}

}  // namespace
}  // namespace steadyrest::thermal::online
