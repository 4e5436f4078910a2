// SPDX-License-Identifier: Apache-2.0
#include <cmath>

#include <gtest/gtest.h>

#include <steadyrest/motion/offline/test/scenes.hpp>
#include <steadyrest/motion/online/estimator/pll.hpp>

namespace steadyrest::motion::offline::test {
namespace {

using online::Pll;

// v/v_true = ki/(s² + kp·s + ki) lags by kp/ki = 2/b; the discrete loop by half a tick less.
TEST(Pll, ComesLateByTwoOverItsBandwidthLessHalfATick) {
  // Steady ramp of the sampled loop: d = a/ki, v_k = v(t_k) + a·T/2 − a·kp/ki.
  for (const double bandwidth : {100.0, 200.0, 300.0}) {
    const Record record = offline::record(ramp(5.0, 100.0, 1.0), {});
    Pll estimator = Pll::make({.bandwidth_rad_s = bandwidth}).value();
    const double lag_s = -mean_velocity_error(run(estimator, record), record, 0.2) / 100.0;
    EXPECT_NEAR(lag_s, 2.0 / bandwidth - 0.0005, 5e-5) << bandwidth;
  }
}

TEST(Pll, FollowsAConstantSpeedWithoutBias) {
  const Record record = offline::record(constant_speed(7.3819, 2.0), {});
  Pll estimator = Pll::make({}).value();
  EXPECT_NEAR(mean_velocity_error(run(estimator, record), record, 0.5), 0.0, 1e-3);
}

TEST(Pll, GivesTheTableOfTheReference) {
  // Row "ODrive PLL bw 300", ±10 %.
  EXPECT_NEAR(scored<Pll>({}, sine_ideal()).velocity_rms_mm_s, 0.68, 0.068);
  EXPECT_NEAR(scored<Pll>({}, sine_line_errors()).velocity_rms_mm_s, 0.68, 0.068);
  EXPECT_NEAR(scored<Pll>({}, sine_ideal(), 0.00625).velocity_rms_mm_s, 0.047, 0.0047);
  EXPECT_NEAR(scored<Pll>({}, s_curve_ideal()).velocity_rms_mm_s, 0.47, 0.047);
  EXPECT_NEAR(scored<Pll>({}, s_curve_line_errors()).velocity_rms_mm_s, 0.47, 0.047);
}

TEST(Pll, SnapsToZeroAtStandstillAndStaysThere) {
  Pll estimator = Pll::make({}).value();
  for (int k = 0; k < 300; ++k) {
    const std::int64_t count = std::min(k, 50);
    const double low = static_cast<double>(count) * 0.001;
    const Estimate e = estimator.tick({k * 0.001, count, low, low + 0.001});
    if (k > 150) {
      EXPECT_EQ(e.velocity_mm_s, 0.0) << k;
    }
  }
}

TEST(Pll, RefusesABandwidthThatWouldNotBeStable) {
  EXPECT_FALSE(Pll::make({.bandwidth_rad_s = 500.0}).has_value());
  EXPECT_TRUE(Pll::make({.bandwidth_rad_s = 499.0}).has_value());
  EXPECT_FALSE(Pll::make({.bandwidth_rad_s = 0.0}).has_value());
  EXPECT_FALSE(Pll::make({.count_mm = -1.0}).has_value());
}

}  // namespace
}  // namespace steadyrest::motion::offline::test
