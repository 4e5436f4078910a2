// SPDX-License-Identifier: Apache-2.0
#include <cmath>
#include <functional>
#include <limits>
#include <vector>

#include <gtest/gtest.h>
#include <rapidcheck.h>

#include <steadyrest/sim/axis/axis_servo.hpp>
#include <steadyrest/sim/axis/test/test_axes.hpp>

namespace steadyrest::sim {
namespace {

using kernel::machine::Axis;
using test::ideal_axis;
using test::rubbing_axis;
using test::servo;

// Steady state of the axis law: e = (1 − a)·v/k, whatever τ is.
TEST(AxisServo, LagsAStraightLineByVelocityOverGain) {
  for (const double feed_forward : {0.0, 0.5, 0.9}) {
    for (const double lag_s : {0.0, 0.004}) {
      Axis axis = ideal_axis(40.0);
      axis.feed_forward = feed_forward;
      axis.velocity_lag_s = lag_s;
      AxisServo x = servo(axis);
      for (int i = 1; i <= 2000; ++i) {
        x.update(0.03 * i, 30.0);
      }
      EXPECT_NEAR(x.state().command_mm - x.state().table_mm, (1.0 - feed_forward) * 30.0 / 40.0,
                  1e-9);
    }
  }
}

// The paper's formula (2) for a line: ε = v/2·sin 2θ·|1/kx − 1/ky|.
TEST(AxisServo, MismatchOnAStraightLineGivesFormulaTwo) {
  const double angle = 0.6;
  const double speed_mm_s = 50.0;
  AxisServo x = servo(ideal_axis(30.0));
  AxisServo y = servo(ideal_axis(36.0));
  for (int i = 1; i <= 2000; ++i) {
    const double s = speed_mm_s * 0.001 * i;
    x.update(s * std::cos(angle), speed_mm_s * std::cos(angle));
    y.update(s * std::sin(angle), speed_mm_s * std::sin(angle));
  }
  const double distance_mm =
      std::abs(-std::sin(angle) * x.state().table_mm + std::cos(angle) * y.state().table_mm);
  EXPECT_NEAR(distance_mm,
              speed_mm_s / 2.0 * std::sin(2.0 * angle) * std::abs(1.0 / 30.0 - 1.0 / 36.0), 1e-9);
}

// A step of 5 mm exceeds the drive's ability; its limit must hold in each period, and the motion
// must be the integral of the velocity.
TEST(AxisServo, NeverExceedsTheDriveLimit) {
  for (const double lag_s : {0.0, 0.003}) {
    Axis axis = ideal_axis(50.0);
    axis.velocity_lag_s = lag_s;
    axis.drive_acceleration_au_s2 = 400.0;
    AxisServo x = servo(axis);
    double velocity = 0.0;
    double position = 0.0;
    bool saturated = false;
    for (int i = 1; i <= 3000; ++i) {
      x.update(5.0, 0.0);  // a step
      ASSERT_LE(std::abs(x.state().velocity_mm_s - velocity), 400.0 * 0.001 * (1.0 + 1e-9));
      ASSERT_NEAR(x.state().motor_mm - position, (x.state().velocity_mm_s + velocity) / 2.0 * 0.001,
                  400.0 * 1e-6);
      velocity = x.state().velocity_mm_s;
      position = x.state().motor_mm;
      saturated = saturated || x.state().saturated;
    }
    EXPECT_TRUE(saturated);
    EXPECT_NEAR(x.state().table_mm, 5.0, 1e-6);
  }
}

// At the limit v = a·t and x = a·t²/2 to rounding.
TEST(AxisServo, SaturatedStartFollowsConstantAcceleration) {
  Axis axis = ideal_axis(50.0);
  axis.drive_acceleration_au_s2 = 1000.0;
  AxisServo x = servo(axis);
  for (int i = 1; i <= 50; ++i) {
    x.update(100.0, 0.0);
  }
  EXPECT_NEAR(x.state().velocity_mm_s, 50.0, 1e-9);
  EXPECT_NEAR(x.state().motor_mm, 0.5 * 1000.0 * 0.05 * 0.05, 1e-9);
}

// Any preference for one direction (a sign of zero, a rounding) breaks the mirror image.
TEST(AxisServo, IsOddMirroredCommandGivesMirroredMotion) {
  EXPECT_TRUE(rc::check("x(−c) = −x(c), bit for bit", [] {
    Axis axis = rubbing_axis();
    axis.backlash_au = 0.004;
    axis.drive_acceleration_au_s2 = 2500.0;
    AxisServo left = servo(axis);
    AxisServo right = servo(axis);
    const auto jumps = *rc::gen::container<std::vector<int>>(20, rc::gen::inRange(-300, 300));
    double c = 0.0;
    for (const int jump : jumps) {
      c += jump * 1e-3;
      for (int i = 0; i < 20; ++i) {
        left.update(-c, 0.0);
        right.update(c, 0.0);
        RC_ASSERT(left.state().table_mm == -right.state().table_mm);
      }
    }
  }));
}

// One fault each; NaN must fail like any other value.
TEST(AxisServo, RefusesAbsurdAxes) {
  const double nan = std::numeric_limits<double>::quiet_NaN();
  const std::vector<std::function<void(AxisServo::Config&)>> faults = {
      [&](auto& c) { c.axis.servo_gain_1_s = 0.0; },
      [&](auto& c) { c.axis.servo_gain_1_s = nan; },
      [&](auto& c) { c.axis.feed_forward = -0.1; },
      [&](auto& c) { c.axis.velocity_lag_s = -1e-3; },
      [&](auto& c) { c.axis.drive_acceleration_au_s2 = 0.0; },
      [&](auto& c) { c.axis.backlash_au = nan; },
      [&](auto& c) { c.axis.friction.stribeck_au_s = 0.0; },
      [&](auto& c) { c.axis.friction.coulomb_au_s2 = -1.0; },
      [&](auto& c) { c.period_s = 0.0; },
      [&](auto& c) { c.drive_period_s = nan; },
      [&](auto& c) { c.axis.encoder.count_au = -1.0; },
  };
  for (const auto& fault : faults) {
    AxisServo::Config config;
    fault(config);
    const auto made = AxisServo::make(config);
    ASSERT_FALSE(made);
    EXPECT_FALSE(made.error().what.empty());
    EXPECT_FALSE(made.error().to_do.empty());
  }
}

}  // namespace
}  // namespace steadyrest::sim
