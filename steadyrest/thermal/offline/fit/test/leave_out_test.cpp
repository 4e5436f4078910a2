// SPDX-License-Identifier: Apache-2.0
#include <cmath>
#include <vector>

#include <gtest/gtest.h>

#include <steadyrest/thermal/offline/fit/leave_out.hpp>
#include <steadyrest/thermal/offline/test/synthetic_log.hpp>

namespace steadyrest::thermal::offline {
namespace {

LeftOut of_losses(std::vector<double> loss) {
  LeftOut out;
  out.loss = std::move(loss);
  return out;
}

// A reading each 20 min: probed at 0, 60 and 120 min, so each error counts from the last probe's.
TEST(Probed, CountsFromTheReadingOfEachHour) {
  FitData data;
  for (int i = 0; i < 9; ++i) {
    data.time_s.push_back(5000.0 + 1200.0 * i);
  }
  Eigen::VectorXd residual(8);
  residual << 3, 4, 6, 10, 9, 7, -1, 0;
  Eigen::VectorXd want(8);
  want << 0, 1, 3, 0, -1, -3, 0, 1;
  EXPECT_EQ(probed(data, {1, 9}, residual), want);
}

// ½·ln of the product of both RMS; 0.2 µm and less make no difference.
TEST(BlockLoss, ComparesByRatios) {
  EXPECT_NEAR(block_loss(400.0, 100.0) - block_loss(100.0, 25.0), std::log(2.0), 1e-3);
  EXPECT_NEAR(block_loss(400.0, 100.0), block_loss(100.0, 400.0), 1e-12) << "both uses count alike";
  EXPECT_NEAR(block_loss(1e-8, 1e-8), block_loss(0.0, 0.0), 1e-6);
  EXPECT_TRUE(std::isfinite(block_loss(0.0, 0.0)));
  EXPECT_NEAR(block_loss(0.04, 0.04) - block_loss(0.0, 0.0), 0.5 * std::log(2.0), 1e-12);
}

// Worse by d in each of four blocks, and differing by ±s: the standard error is s·√(4/3)/2.
TEST(AsGood, AllowsOneStandardErrorButNoMoreThanATenth) {
  const LeftOut best = of_losses({1.0, 2.0, 3.0, 4.0});
  const auto worse = [](double d, double s) {
    return of_losses({1.0 + d + s, 2.0 + d - s, 3.0 + d + s, 4.0 + d - s});
  };
  EXPECT_TRUE(as_good(best, best));
  EXPECT_TRUE(as_good(worse(-1.0, 0.0), best)) << "better is as good";
  EXPECT_TRUE(as_good(worse(0.029, 0.0), best)) << "3 % justify nothing";
  EXPECT_FALSE(as_good(worse(0.031, 0.0), best));
  const double error = 0.1 * std::sqrt(4.0 / 3.0) / 2.0;
  EXPECT_TRUE(as_good(worse(error - 1e-6, 0.1), best));
  EXPECT_FALSE(as_good(worse(error + 1e-6, 0.1), best));
  EXPECT_TRUE(as_good(worse(0.099, 5.0), best));
  EXPECT_FALSE(as_good(worse(0.101, 5.0), best)) << "however hard the blocks are";
}

// The truth has one mode of 40 min. Left out, its runs are forecast to the noise; by a model of
// 300 min they are not, though it too fits the rest as well as it can.
TEST(LeaveOut, ForecastsLeftOutRunsToTheNoiseWithTheTrueTimeConstantAlone) {
  auto days = test::kDays;
  days.insert(days.begin(), {30, 0.0});
  const Log log = test::log_of({{{40.0, 8.0}}, 0.3, 0.0, 0.0, 2}, days);
  const FitData data = fit_data(log, 0, -1e300, 1e300);
  ASSERT_EQ(data.block.size(), 4U);
  const ErrorModel error{.drift_um = 0.3, .tau_s = 3600.0, .noise_um = 0.3};
  const auto left_out = [&](double tau_min) {
    Structure structure;
    structure.mode = {{60.0 * tau_min, 0.0}};
    return leave_out(structure, data, error, wide_prior(structure, data));
  };
  const LeftOut right = left_out(40.0);
  EXPECT_GT(right.free_rms_um, 0.25);
  EXPECT_LT(right.free_rms_um, 0.45);
  EXPECT_EQ(right.residual_um.array().isFinite().count(), static_cast<Eigen::Index>(data.rows()));
  const LeftOut wrong = left_out(300.0);
  EXPECT_GT(wrong.free_rms_um, 3.0);
  EXPECT_TRUE(as_good(right, wrong));
  EXPECT_FALSE(as_good(wrong, right));
}

}  // namespace
}  // namespace steadyrest::thermal::offline
