// SPDX-License-Identifier: Apache-2.0
#include <cmath>

#include <gtest/gtest.h>

#include <steadyrest/motion/offline/test/scenes.hpp>
#include <steadyrest/motion/online/estimator/backward_difference.hpp>

namespace steadyrest::motion::offline::test {
namespace {

using online::BackwardDifference;

constexpr double kCycle = 0.001;

Score at_constant_speed(double counts_per_tick, std::size_t ticks) {
  const Record record = offline::record(constant_speed(counts_per_tick, 2.0), {});
  return scored<BackwardDifference>({kCount, kCycle, ticks}, record, 0.0, 0.2);
}

TEST(BackwardDifference, VarianceAtConstantSpeedIsThatOfARoundedCount) {
  // f·(1 − f)·q²: the error is −f with the share 1 − f of the ticks and 1 − f with the share f.
  for (const double f : {0.0809017, 0.2190983, 0.381966, 0.618034, 0.9111456}) {
    const double expected = std::sqrt(f * (1.0 - f)) * kCount / kCycle;
    EXPECT_NEAR(at_constant_speed(3.0 + f, 1).velocity_rms_mm_s, expected, 0.01 * expected) << f;
  }
}

TEST(BackwardDifference, MeanOverAllSpeedsIsTheCountOverRootSixAndRootTwo) {
  for (const std::size_t m : {1U, 4U}) {
    double v2 = 0.0;
    double a2 = 0.0;
    constexpr int kSpeeds = 60;
    for (int i = 0; i < kSpeeds; ++i) {
      const Score s = at_constant_speed(5.0 + (i + 0.4142) / kSpeeds, m);
      v2 += s.velocity_rms_mm_s * s.velocity_rms_mm_s / kSpeeds;
      a2 += s.acceleration_rms_mm_s2 * s.acceleration_rms_mm_s2 / kSpeeds;
    }
    const double span = static_cast<double>(m) * kCycle;
    EXPECT_NEAR(std::sqrt(v2) * span / kCount, 1.0 / std::sqrt(6.0), 0.01) << m;
    EXPECT_NEAR(std::sqrt(a2) * span * span / kCount, 1.0 / std::sqrt(2.0), 0.02) << m;
  }
}

TEST(BackwardDifference, ComesLateByHalfItsSpan) {
  const Record record = offline::record(ramp(5.0, 100.0, 1.0), {});
  for (const std::size_t m : {1U, 4U, 10U}) {
    BackwardDifference estimator = BackwardDifference::make({kCount, kCycle, m}).value();
    const double lag_s = -mean_velocity_error(run(estimator, record), record, 0.05) / 100.0;
    EXPECT_NEAR(lag_s, 0.5 * static_cast<double>(m) * kCycle, 1e-5) << m;
  }
}

TEST(BackwardDifference, GivesTheTableOfTheReference) {
  // Rows "diff 1 tick", "diff 4 ticks" and "2nd diff 5" (±10 %: another stretch of the same
  // scenes).
  EXPECT_NEAR(scored<BackwardDifference>({}, sine_ideal()).velocity_rms_mm_s, 0.430, 0.043);
  EXPECT_NEAR(scored<BackwardDifference>({}, sine_line_errors()).velocity_rms_mm_s, 0.421, 0.042);
  EXPECT_NEAR(scored<BackwardDifference>({}, s_curve_ideal()).velocity_rms_mm_s, 0.224, 0.023);
  EXPECT_NEAR(scored<BackwardDifference>({}, s_curve_line_errors()).velocity_rms_mm_s, 0.225,
              0.023);
  EXPECT_NEAR(scored<BackwardDifference>({.ticks = 4}, sine_ideal()).velocity_rms_mm_s, 0.242,
              0.024);
  EXPECT_NEAR(scored<BackwardDifference>({.ticks = 4}, sine_ideal(), 0.002).velocity_rms_mm_s,
              0.098, 0.0098);
  EXPECT_NEAR(scored<BackwardDifference>({.ticks = 5}, sine_ideal(), 0.005).acceleration_rms_mm_s2,
              29.0, 2.9);
  EXPECT_NEAR(
      scored<BackwardDifference>({.ticks = 5}, s_curve_ideal(), 0.005).acceleration_rms_mm_s2, 20.0,
      2.0);
}

TEST(BackwardDifference, IsExactOnWholeCountsPerTick) {
  BackwardDifference estimator = BackwardDifference::make({kCount, kCycle, 3}).value();
  Estimate e;
  for (std::int64_t k = 0; k < 40; ++k) {
    const std::int64_t count = k * k;  // v = 2k counts/tick at the tick, a = 2
    const double low = static_cast<double>(count) * kCount;
    e = estimator.tick({static_cast<double>(k) * kCycle, count, low, low + kCount});
  }
  EXPECT_NEAR(e.velocity_mm_s, 2.0 * (39 - 1.5), 1e-9);
  EXPECT_NEAR(e.acceleration_mm_s2, 2000.0, 1e-6);
}

TEST(BackwardDifference, RefusesWhatCannotWork) {
  EXPECT_FALSE(BackwardDifference::make({.count_mm = 0.0}).has_value());
  EXPECT_FALSE(BackwardDifference::make({.cycle_s = std::nan("")}).has_value());
  EXPECT_FALSE(BackwardDifference::make({.ticks = 0}).has_value());
  EXPECT_FALSE(BackwardDifference::make({.ticks = 65}).has_value());
}

}  // namespace
}  // namespace steadyrest::motion::offline::test
