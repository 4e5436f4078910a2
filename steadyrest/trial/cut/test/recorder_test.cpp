// SPDX-License-Identifier: Apache-2.0
#include <cmath>

#include <gtest/gtest.h>

#include <steadyrest/trial/cut/recorder.hpp>

namespace steadyrest::trial::cut {
namespace {

using kernel::outcome::Reason;
using kernel::signal::Motion;

Sample cutting(double time_s, double error_mm, std::uint32_t line = 1) {
  Sample sample;
  sample.time_s = time_s;
  sample.contour_error_mm = error_mm;
  sample.line = line;
  sample.motion = Motion::feed;
  return sample;
}

TEST(Recorder, FiguresAreTakenOverCuttingMotionAlone) {
  Recorder recorder({.limit_mm = 0.010, .cycle_s = 0.5});
  recorder.add(cutting(0.5, 0.003));
  recorder.add(cutting(1.0, -0.004));
  Sample rapid = cutting(1.5, 9.0);
  rapid.motion = Motion::rapid;
  recorder.add(rapid);
  const Figures figures = recorder.figures();
  EXPECT_DOUBLE_EQ(figures.cycle_time_s, 1.5);
  EXPECT_DOUBLE_EQ(figures.cutting_time_s, 1.0);
  EXPECT_DOUBLE_EQ(figures.contour_error_max_mm, 0.004);
  EXPECT_DOUBLE_EQ(figures.contour_error_rms_mm, std::sqrt((9e-6 + 16e-6) / 2));
  EXPECT_EQ(figures.samples_over_limit, 0U);
}

// The tool still cuts, but the program's time is over.
TEST(Recorder, ErrorsBehindTheEndCountWithoutItsTime) {
  Recorder recorder({.limit_mm = 0.010, .cycle_s = 0.5});
  recorder.add(cutting(0.5, 0.003));
  Sample late = cutting(1.0, 0.020);
  late.after_end = true;
  recorder.add(late);
  const Figures figures = recorder.figures();
  EXPECT_DOUBLE_EQ(figures.cycle_time_s, 0.5);
  EXPECT_DOUBLE_EQ(figures.contour_error_max_mm, 0.020);
  EXPECT_NEAR(recorder.time_by_reason().at(Reason::none), 0.5, 1e-12);
}

TEST(Recorder, TimeOverTheLimitCountsBothSigns) {
  Recorder recorder({.limit_mm = 0.010, .cycle_s = 0.002});
  for (const double error_mm : {0.011, -0.012, 0.010, 0.0}) {
    recorder.add(cutting(0.0, error_mm));
  }
  EXPECT_EQ(recorder.figures().samples_over_limit, 2U);
  EXPECT_DOUBLE_EQ(recorder.figures().over_limit_s, 0.004);
}

TEST(Recorder, CountsChangesOfTheOverrideAndTimeByReason) {
  Recorder recorder({.limit_mm = 0.010, .cycle_s = 0.1});
  for (const double ratio : {1.0, 1.0, 0.5, 0.5, 1.0}) {
    Sample sample = cutting(0.0, 0.0);
    sample.feed_ratio = ratio;
    sample.reason = ratio < 1.0 ? Reason::contour_limit : Reason::none;
    recorder.add(sample);
  }
  EXPECT_EQ(recorder.figures().override_changes, 2U);
  EXPECT_NEAR(recorder.time_by_reason().at(Reason::contour_limit), 0.2, 1e-12);
}

TEST(Recorder, ThinnedTraceKeepsTheExtremeAndTheOrder) {
  Recorder recorder({.limit_mm = 0.010, .cycle_s = 0.001, .max_points = 64});
  for (int i = 0; i < 10'000; ++i) {
    recorder.add(cutting(i * 0.001, i == 7777 ? -0.5 : 0.001));
  }
  double largest_mm = 0.0;
  double last_s = -1.0;
  for (const Sample& sample : recorder.trace()) {
    largest_mm = std::max(largest_mm, std::abs(sample.contour_error_mm));
    EXPECT_GT(sample.time_s, last_s);
    last_s = sample.time_s;
  }
  EXPECT_LE(recorder.trace().size(), 64U);
  EXPECT_GE(recorder.trace().size(), 32U);
  EXPECT_DOUBLE_EQ(largest_mm, 0.5);
  EXPECT_GT(last_s, 9.5);
}

TEST(Recorder, KeepsTheWorstSignedErrorOfEachLine) {
  Recorder recorder({});
  recorder.add(cutting(0.0, 0.001, 7));
  recorder.add(cutting(0.1, -0.003, 7));
  recorder.add(cutting(0.2, 0.002, 9));
  const auto errors = recorder.line_errors();
  ASSERT_EQ(errors.size(), 2U);
  EXPECT_EQ(errors[0].line, 7U);
  EXPECT_DOUBLE_EQ(errors[0].contour_error_mm, -0.003);
  EXPECT_EQ(errors[1].line, 9U);
}

}  // namespace
}  // namespace steadyrest::trial::cut
