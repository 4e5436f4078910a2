// SPDX-License-Identifier: Apache-2.0
#include <limits>

#include <gtest/gtest.h>

#include <steadyrest/motion/offline/scene/line_calibration.hpp>
#include <steadyrest/motion/offline/scene/test/learnt_lines.hpp>
#include <steadyrest/motion/offline/test/scenes.hpp>
#include <steadyrest/motion/online/bounded/motion_estimator.hpp>

namespace steadyrest::motion::offline::test {
namespace {

using online::MotionEstimator;

Score kalman_score(const Record& record, double max_jerk_mm_s3 = online::kNoBound) {
  return test::scored<MotionEstimator>({.max_jerk_mm_s3 = max_jerk_mm_s3}, record);
}

// The required target: half of the error before, with and without limits.
TEST(LineCalibration, BringsTheEstimatorBelowTheTarget) {
  const auto calibration = calibrate_lines(long_sine(), {});
  ASSERT_TRUE(calibration);
  EXPECT_EQ(calibration->edges, long_sine().edges.size());
  EXPECT_GT(calibration->lines_learnt, 1900U);
  EXPECT_LT(calibration->residual_after_mm, 0.12 * calibration->residual_before_mm);
  Record calibrated = long_sine();
  apply_lines(calibration->table, calibrated);
  for (const double jerk : {online::kNoBound, long_sine().max_jerk_mm_s3}) {
    const Score before = kalman_score(long_sine(), jerk);
    EXPECT_GT(before.velocity_rms_mm_s, 0.008);
    EXPECT_GT(before.acceleration_rms_mm_s2, 4.0);
    const Score after = kalman_score(calibrated, jerk);
    EXPECT_LT(after.velocity_rms_mm_s, 0.0040);
    EXPECT_LT(after.acceleration_rms_mm_s2, 2.4);
  }
}

TEST(LineCalibration, HoldsForAMotionThatItDidNotSee) {
  // Learnt on 2 Hz, used at 1 Hz: the same encoder (seed), other speeds.
  const auto calibration = calibrate_lines(long_sine(), {});
  ASSERT_TRUE(calibration);
  const Record other = offline::record(sine(1.0, 1.0, 4.0), line_errors());
  Record calibrated = other;
  apply_lines(calibration->table, calibrated);
  EXPECT_LT(kalman_score(calibrated).velocity_rms_mm_s,
            0.6 * kalman_score(other).velocity_rms_mm_s);
  EXPECT_LT(kalman_score(calibrated).acceleration_rms_mm_s2,
            0.6 * kalman_score(other).acceleration_rms_mm_s2);
}

// To the last digit: a calibration without effect must not change the estimate.
TEST(LineCalibration, WithIdealLinesTheEstimatorIsAsGoodAsBefore) {
  const auto calibration = calibrate_lines(long_sine_ideal(), {});
  ASSERT_TRUE(calibration);
  Record calibrated = long_sine_ideal();
  apply_lines(calibration->table, calibrated);
  const Score before = kalman_score(long_sine_ideal());
  const Score after = kalman_score(calibrated);
  EXPECT_DOUBLE_EQ(after.velocity_rms_mm_s, before.velocity_rms_mm_s);
  EXPECT_DOUBLE_EQ(after.acceleration_rms_mm_s2, before.acceleration_rms_mm_s2);
}

TEST(LineCalibration, RefusesWhatCannotWork) {
  EXPECT_FALSE(calibrate_lines(Record{}, {}));
  EXPECT_FALSE(calibrate_lines(sine_line_errors(), {.passes = 0}));
  EXPECT_FALSE(calibrate_lines(sine_line_errors(), {.counts_per_rev = 1001}));
  EXPECT_FALSE(calibrate_lines(sine_line_errors(), {.range = LineRange{10, 9}}));
  EXPECT_FALSE(calibrate_lines(sine_line_errors(), {.range = LineRange{0, 1 << 20}}));
  EXPECT_FALSE(calibrate_lines(sine_line_errors(),
                               {.range = LineRange{std::numeric_limits<std::int64_t>::min(),
                                                   std::numeric_limits<std::int64_t>::max()}}));
}

}  // namespace
}  // namespace steadyrest::motion::offline::test
