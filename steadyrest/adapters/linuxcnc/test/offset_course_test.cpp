// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <cmath>

#include <gtest/gtest.h>

#include <steadyrest/adapters/linuxcnc/offset_course.hpp>
#include <steadyrest/adapters/linuxcnc/testing/offset_planner.hpp>

namespace steadyrest::adapters::linuxcnc {
namespace {

using testing::OffsetPlanner;

constexpr double kPeriod_s = 0.001;

/// Largest distance from 0.56·sin(6.67·t) mm that the planner's output keeps: the offset that a
/// circle of 10 mm at F4000 needs with a position loop of 20 1/s.
double worst_mm(double acceleration) {
  OffsetCourse course({.acceleration = {acceleration}});
  OffsetPlanner planner(40.0, 400.0);
  double worst = 0.0;
  for (std::uint64_t tick = 1; tick < 5000; ++tick) {
    Pins pins;
    pins.offset[0] = 0.02;
    pins.path_offset[0] = 0.56 * std::sin(6.67 * kPeriod_s * static_cast<double>(tick));
    const double asked = pins.offset[0] + pins.path_offset[0];
    course.apply(pins, true, tick, kPeriod_s);
    const double got = planner.update(pins.offset[0] + pins.path_offset[0]);
    if (tick > 200) {
      worst = std::max(worst, std::abs(got - asked));
    }
  }
  return worst;
}

TEST(OffsetCourse, LeadsByWhatThePlannerLags) {
  EXPECT_GT(worst_mm(0.0), 0.015) << "v²/2a is 17 µm";
  EXPECT_LT(worst_mm(400.0), 0.001);
}

TEST(OffsetCourse, PassesOnWhatRests) {
  OffsetCourse course({.acceleration = {400.0}, .in_force = {0.03}});
  Pins pins;
  for (std::uint64_t tick = 1; tick < 200; ++tick) {
    pins = {};
    pins.offset[0] = 0.03;
    pins.path_offset[2] = -0.01;
    course.apply(pins, true, tick, kPeriod_s);
    EXPECT_EQ(pins.offset[0], 0.03);
    EXPECT_EQ(pins.path_offset[2], -0.01);
  }
  EXPECT_NEAR(pins.path_offset[0], 0.0, 1e-6) << "at rest";
}

// A corner asks for a jump; the planner needs 2·√(2 mm/400 mm/s²) = 141 ms for 2 mm.
TEST(OffsetCourse, DoesNotOvershootWhereMoreIsAskedThanTheAxisCanDo) {
  OffsetCourse course({.acceleration = {400.0}});
  OffsetPlanner planner(40.0, 400.0);
  double at = 0.0;
  double most = 0.0;
  double least = 0.0;
  for (std::uint64_t tick = 1; tick < 1200; ++tick) {
    Pins pins;
    pins.path_offset[0] = tick < 600 ? 2.0 : -2.0;
    course.apply(pins, true, tick, kPeriod_s);
    at = planner.update(pins.offset[0] + pins.path_offset[0]);
    most = std::max(most, at);
    least = std::min(least, at);
    if (tick == 200 || tick == 1000) {
      EXPECT_NEAR(std::abs(at), 2.0, 0.01) << tick;
    }
  }
  EXPECT_LT(most, 2.02);
  EXPECT_GT(least, -2.02);
}

// The offset that a circle's beginning asks for: it grows as fast as the axis can and then stays.
TEST(OffsetCourse, OvershootsLittleWhereATargetStopsAtOnce) {
  OffsetCourse course({.acceleration = {400.0}});
  OffsetPlanner planner(40.0, 400.0);
  double most = 0.0;
  for (std::uint64_t tick = 1; tick < 400; ++tick) {
    const double t = kPeriod_s * static_cast<double>(tick);
    Pins pins;
    pins.path_offset[0] = std::min(0.578, 0.023 + 5.0 * t + 180.0 * t * t);
    course.apply(pins, true, tick, kPeriod_s);
    most = std::max(most, planner.update(pins.offset[0] + pins.path_offset[0]));
  }
  EXPECT_LT(most, 1.07 * 0.578) << "without the bound 0.73";
}

// Off and on bakes an offset into the position (LinuxCNC 2.9): it must be 0 when the machine comes
// on again, and grow from there.
TEST(OffsetCourse, GrowsFromNothingAfterTheMachineWasOff) {
  OffsetCourse course({.in_force = {0.0, -0.03}});
  const auto given = [&](std::uint64_t tick, bool enabled) {
    Pins pins;
    pins.offset[1] = -0.03;
    pins.path_offset[0] = 0.01;
    course.apply(pins, enabled, tick, kPeriod_s);
    return pins;
  };
  EXPECT_EQ(given(1, true).offset[1], -0.03);
  for (std::uint64_t tick = 2; tick < 10; ++tick) {
    EXPECT_EQ(given(tick, false).offset[1], 0.0);
    EXPECT_EQ(given(tick, false).path_offset[0], 0.0);
  }
  double before = 0.0;
  for (std::uint64_t tick = 10; tick < 60; ++tick) {
    const double now = given(tick, true).offset[1];
    EXPECT_LE(std::abs(now - before), 0.001 + 1e-12);
    before = now;
  }
  EXPECT_EQ(before, -0.03);
}

TEST(OffsetCourse, GrowsByWhatIsAMillimetrePerSecondInTheControlsUnit) {
  OffsetCourse course({.back = 1.0 / 25.4});
  for (std::uint64_t tick = 1; tick <= 10; ++tick) {
    Pins pins;
    pins.offset[1] = 0.1;
    course.apply(pins, tick > 1, tick, kPeriod_s);
    EXPECT_NEAR(25.4 * pins.offset[1], 0.001 * static_cast<double>(tick - 1), 1e-9);
  }
}

// A layer that was killed left 50 µm; the next one's supervisor begins at 0. In the cut, a jump
// would leave a step in the part.
TEST(OffsetCourse, GoesOnFromTheOffsetOfAnEarlierLayer) {
  OffsetCourse course({.acceleration = {400.0}, .in_force = {0.05}, .slew = 0.05});
  double before = 0.05;
  for (std::uint64_t tick = 1; tick <= 1010; ++tick) {
    Pins pins;
    course.apply(pins, true, tick, kPeriod_s);
    const double now = pins.offset[0] + pins.path_offset[0];
    EXPECT_LE(std::abs(now - before), 0.06 * kPeriod_s) << tick;
    EXPECT_NEAR(pins.offset[0], std::max(0.0, 0.05 - 5e-5 * static_cast<double>(tick)), 1e-9);
    before = now;
  }
  EXPECT_NEAR(before, 0.0, 1e-6);
}

// After a stall that the watchdog ended the supervisor begins at 0, too.
TEST(OffsetCourse, DoesNotFollowAJump) {
  OffsetCourse course({.in_force = {0.05}, .slew = 0.05});
  Pins pins;
  pins.offset[0] = 0.05;
  course.apply(pins, true, 1, kPeriod_s);
  EXPECT_EQ(pins.offset[0], 0.05);
  pins = {};
  course.apply(pins, true, 301, kPeriod_s);
  EXPECT_NEAR(pins.offset[0], 0.049, 1e-9) << "a gap counts as 20 cycles at most";
}

}  // namespace
}  // namespace steadyrest::adapters::linuxcnc
