// SPDX-License-Identifier: Apache-2.0
#include <cmath>

#include <gtest/gtest.h>

#include <steadyrest/motion/online/bounded/lag_smoother.hpp>
#include <steadyrest/motion/online/bounded/test/lag_scene.hpp>

namespace steadyrest::motion::online::test {
namespace {

constexpr int kLagTicks = 24;

// The smoother's backward filters start with a weak prior, so a thousandth is left.
TEST(LagSmoother, KnowsWhatAllPassagesTogetherTell) {
  for (const std::size_t lag : {3U, 8U, 16U}) {
    const LagSmoother::State found = lag_fed(lag, kLagTicks).smooth(all(kLagJerk), kLagCycle_s);
    const double end_s = kLagTicks * kLagCycle_s;
    const double at_s = end_s - static_cast<double>(lag) * kLagCycle_s;
    const Eigen::Vector3d whole = lag_known(at_s, end_s, kLagTicks);
    const Eigen::Vector3d before = lag_known(at_s, at_s, kLagTicks);
    EXPECT_NEAR(found.x, whole[0], 2e-3 * std::abs(before[0] - whole[0]) + 1e-6) << lag;
    EXPECT_NEAR(found.v, whole[1], 2e-3 * std::abs(before[1] - whole[1])) << lag;
    EXPECT_NEAR(found.a, whole[2], 2e-3 * std::abs(before[2] - whole[2])) << lag;
    EXPECT_GT(std::abs(before[2] - whole[2]), 100.0) << "the future tells something";
  }
}

TEST(LagSmoother, LooksBackByTheLagOnceThatManyTicksAreThere) {
  EXPECT_NEAR(lag_fed(8, 3).then().t_s, 1 * kLagCycle_s, 1e-12) << "the oldest there is";
  EXPECT_NEAR(lag_fed(8, 9).then().t_s, 1 * kLagCycle_s, 1e-12);
  EXPECT_NEAR(lag_fed(8, 200).then().t_s, 192 * kLagCycle_s, 1e-12);
  EXPECT_NEAR(lag_fed(1000, 200).then().t_s, (200 - 32) * kLagCycle_s, 1e-12)
      << "no lag is longer than kMostTicks";
}

TEST(LagSmoother, AtRestTheAxisIsWhereItRests) {
  const LagSmoother::State rest = lag_fed(4, kLagTicks, 1.0).smooth(all(kLagJerk), kLagCycle_s);
  EXPECT_EQ(rest.x, 0.375);
  EXPECT_EQ(rest.v, 0.0);
  EXPECT_EQ(rest.a, 0.0);
  // Half of the weight on rest halves the speed.
  const LagSmoother::State half = lag_fed(4, kLagTicks, 0.5).smooth(all(kLagJerk), kLagCycle_s);
  const LagSmoother::State moving = lag_fed(4, kLagTicks).smooth(all(kLagJerk), kLagCycle_s);
  EXPECT_NEAR(half.v, 0.5 * moving.v, 1e-9 * std::abs(moving.v));
  EXPECT_NEAR(half.x, 0.5 * (moving.x + 0.375), 1e-9);
}

TEST(LagSmoother, ForgetsWhatWasBefore) {
  LagSmoother smoother = lag_fed(8, kLagTicks);
  smoother.forget();
  LagSmoother::Look look = lag_fed(8, 1).then();
  look.t_s = 7.0;
  smoother.looked(look);
  EXPECT_EQ(smoother.then().t_s, 7.0);
}

TEST(LagSmoother, WithoutALagIsNotActive) {
  EXPECT_FALSE(LagSmoother(0).active());
  EXPECT_TRUE(LagSmoother(1).active());
  EXPECT_NEAR(lag_fed(0, 5).then().t_s, 5 * kLagCycle_s, 1e-12) << "now";
}

}  // namespace
}  // namespace steadyrest::motion::online::test
