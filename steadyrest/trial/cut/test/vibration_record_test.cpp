// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <cmath>
#include <cstddef>
#include <numbers>

#include <gtest/gtest.h>

#include <steadyrest/trial/cut/vibration_record.hpp>

namespace steadyrest::trial::cut {
namespace {

using Cycle = sim::CuttingVibration::Cycle;

constexpr double kPeriod_s = 0.001;

/// A cycle in the cut in which the tool stays at x, y.
Cycle at_rest(double x_mm, double y_mm = 0.0) {
  return {.cutting_s = kPeriod_s,
          .peak_mm = std::hypot(x_mm, y_mm),
          .sum_mm_s = {x_mm * kPeriod_s, y_mm * kPeriod_s},
          .square_mm2_s = {x_mm * x_mm * kPeriod_s, y_mm * y_mm * kPeriod_s}};
}

TEST(VibrationRecord, HasNoFiguresWhereNothingWasCut) {
  VibrationRecord record;
  EXPECT_FALSE(record.figures());
  record.add(0.0, 50.0, Cycle{});  // in the air
  EXPECT_FALSE(record.figures());
  EXPECT_EQ(record.course().size(), 1U);
}

// A static deflection is no vibration, however large.
TEST(VibrationRecord, RmsIsAboutTheMean) {
  VibrationRecord record;
  for (int i = 0; i < 1000; ++i) {
    record.add(i * kPeriod_s, 50.0, at_rest(0.5, -0.25));
  }
  EXPECT_NEAR(record.figures()->rms_um, 0.0, 1e-4);
  EXPECT_NEAR(record.figures()->peak_um, 1000.0 * std::hypot(0.5, 0.25), 1e-9);
}

// A sine of amplitude A has the RMS A/√2; two of them across each other add as squares.
TEST(VibrationRecord, RmsOfASineIsItsAmplitudeOverRootTwo) {
  VibrationRecord record;
  constexpr int kCycles = 1000;
  for (int i = 0; i < kCycles; ++i) {
    const double phase = 2.0 * std::numbers::pi * i / 20.0;
    record.add(i * kPeriod_s, 50.0, at_rest(0.1 + 0.03 * std::sin(phase), 0.04 * std::cos(phase)));
  }
  EXPECT_NEAR(record.figures()->rms_um, 50.0 / std::numbers::sqrt2, 1e-9);
}

// Time in the air dilutes nothing.
TEST(VibrationRecord, CountsTheTimeInTheCutAlone) {
  VibrationRecord record;
  for (int i = 0; i < 100; ++i) {
    Cycle cycle = i % 2 == 0 ? at_rest(0.0) : Cycle{};
    cycle.unforced_mm2_s = i % 2 == 0 ? 4e-6 * kPeriod_s : 0.0;
    record.add(i * kPeriod_s, 50.0, cycle);
  }
  EXPECT_NEAR(record.figures()->unforced_rms_um, 2.0, 1e-9);
}

TEST(VibrationRecord, KeepsTheLargestOfForcePowerAndChip) {
  VibrationRecord record;
  for (const double size : {1.0, 3.0, 2.0}) {
    Cycle cycle = at_rest(0.0);
    cycle.force_peak_n = 100.0 * size;
    cycle.power_peak_w = 10.0 * size;
    cycle.chip_peak_mm = 0.01 * size;
    record.add(0.0, 50.0, cycle);
  }
  EXPECT_EQ(record.figures()->force_peak_n, 300.0);
  EXPECT_EQ(record.figures()->power_peak_w, 30.0);
  EXPECT_NEAR(record.figures()->chip_peak_um, 30.0, 1e-12);
}

// Cycles without a finished point say nothing about the wall: 0 would be a perfect one.
TEST(VibrationRecord, TheWallIsOfItsOwnPointsAlone) {
  VibrationRecord record;
  record.add(0.0, 50.0, at_rest(0.0));
  EXPECT_FALSE(record.figures()->surface_range_um);
  Cycle wall = at_rest(0.0);
  wall.walls = 3;
  wall.wall_sum_mm = 0.006;
  wall.wall_low_mm = 0.001;
  wall.wall_high_mm = 0.003;
  record.add(0.001, 50.0, wall);
  record.add(0.002, 50.0, at_rest(0.0));
  wall.walls = 1;
  wall.wall_sum_mm = wall.wall_low_mm = wall.wall_high_mm = 0.010;
  record.add(0.003, 50.0, wall);
  EXPECT_NEAR(*record.figures()->surface_error_um, 4.0, 1e-9);  // (6 + 10)/4
  EXPECT_NEAR(*record.figures()->surface_range_um, 9.0, 1e-9);  // 10 − 1
}

// However long the cut, the course has its size, each stretch begins where it does, and no peak is
// lost.
TEST(VibrationRecord, ItsCourseIsBoundedAndLosesNoPeak) {
  for (const std::size_t cycles : {7U, 8U, 9U, 100U, 12'345U}) {
    VibrationRecord record(8);
    for (std::size_t i = 0; i < cycles; ++i) {
      const double time_s = static_cast<double>(i) * kPeriod_s;
      record.add(time_s, 40.0 + 20.0 * static_cast<double>(i % 2),
                 at_rest(i == cycles / 2 ? 0.9 : 0.001));
    }
    const auto course = record.course();
    EXPECT_LE(course.size(), 8U) << cycles;
    EXPECT_GE(course.size(), std::min<std::size_t>(cycles, 4)) << cycles;
    double peak_um = 0.0;
    double before_s = -1.0;
    for (const VibrationPoint& point : course) {
      EXPECT_GT(point.time_s, before_s);
      before_s = point.time_s;
      peak_um = std::max(peak_um, point.peak_um);
    }
    EXPECT_NEAR(peak_um, 900.0, 1e-9) << cycles;
    if (cycles > 8) {
      EXPECT_NEAR(course.front().speed_rpm, 3000.0, 1e-6) << "the mean of 40 and 60 rev/s";
    }
  }
}

}  // namespace
}  // namespace steadyrest::trial::cut
