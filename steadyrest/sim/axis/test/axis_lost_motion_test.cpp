// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <cmath>
#include <numbers>

#include <gtest/gtest.h>
#include <rapidcheck.h>

#include <steadyrest/sim/axis/axis_servo.hpp>
#include <steadyrest/sim/axis/test/test_axes.hpp>

// Backlash and friction of the servo axis.
namespace steadyrest::sim {
namespace {

using kernel::machine::Axis;
using test::ideal_axis;
using test::rubbing_axis;
using test::servo;

// Half the width on either side of the motor; a reversal crosses the whole 12 µm.
TEST(AxisServo, BacklashStepsByItsWidthOnReversal) {
  Axis axis = ideal_axis(50.0);
  axis.backlash_au = 0.012;
  AxisServo x = servo(axis);
  double command = 0.0;
  const auto travel = [&](double velocity_mm_s) {
    for (int i = 0; i < 1000; ++i) {
      command += velocity_mm_s * 0.001;
      x.update(command, velocity_mm_s);
    }
    for (int i = 0; i < 1000; ++i) {
      x.update(command, 0.0);
    }
    return x.state().motor_mm - x.state().table_mm;
  };
  EXPECT_NEAR(travel(10.0), 0.006, 1e-12);
  EXPECT_NEAR(travel(-4.0), -0.006, 1e-12);
  EXPECT_NEAR(x.state().encoder_mm, 6.0, 1e-9);  // the motor's encoder does not see it
  EXPECT_NEAR(x.state().table_mm, 6.006, 1e-9);
  EXPECT_NEAR(travel(4.0), 0.006, 1e-12);
}

// 50 µm at 10 mm/s take 5 ms, plus the time in which the lagging motor reverses.
TEST(AxisServo, TableStandsWhileTheBacklashIsCrossed) {
  Axis axis = ideal_axis(50.0);
  axis.backlash_au = 0.050;
  AxisServo x = servo(axis);
  for (int i = 1; i <= 500; ++i) {
    x.update(0.01 * i, 10.0);
  }
  double table = 0.0;
  int standing = 0;
  for (int i = 1; i <= 500; ++i) {
    x.update(5.0 - 0.01 * i, -10.0);
    standing += x.state().table_mm == table ? 1 : 0;
    EXPECT_EQ(x.state().table_mm == table, x.state().table_velocity_mm_s == 0.0);
    table = x.state().table_mm;
  }
  EXPECT_GT(standing, 4);
  EXPECT_LT(standing, 20);
}

// The glitch is the difference from the same axis without friction: micrometres after each
// reversal, hardly anything elsewhere. A friction without a step at v = 0 would show none.
TEST(AxisServo, FrictionMakesAGlitchAtTheQuadrants) {
  const Axis smooth = [] {
    Axis axis = rubbing_axis();
    axis.friction = {};
    return axis;
  }();
  const double rate = 1000.0 / 60.0 / 20.0;
  AxisServo x = servo(rubbing_axis());
  AxisServo ideal = servo(smooth);
  x.reset(20.0);
  ideal.reset(20.0);
  double near_mm = 0.0;  // within 0.1 s after a reversal
  double far_mm = 0.0;   // anywhere else
  const double half_turn_s = std::numbers::pi / rate;
  for (int i = 1; i <= 20000; ++i) {
    const double t = 0.001 * i;
    const double c = 20.0 * std::cos(rate * t);
    const double v = -20.0 * rate * std::sin(rate * t);
    const double deviation = std::abs(x.update(c, v).table_mm - ideal.update(c, v).table_mm);
    const double since = std::fmod(t - 0.02, half_turn_s);
    if (t > half_turn_s * 0.5) {
      double& worst = since < 0.15 ? near_mm : far_mm;
      worst = std::max(worst, deviation);
    }
  }
  EXPECT_GT(near_mm, 0.005);
  EXPECT_LT(near_mm, 0.1);
  EXPECT_LT(far_mm, near_mm / 5.0);
}

// The integral part takes over the friction: v/k is left, and d̂ = 300 + 1·20 mm/s².
TEST(AxisServo, FrictionLeavesNoLagAtConstantVelocity) {
  AxisServo x = servo(rubbing_axis());
  for (int i = 1; i <= 3000; ++i) {
    x.update(0.02 * i, 20.0);
  }
  EXPECT_NEAR(x.state().command_mm - x.state().table_mm, 20.0 / 50.0, 1e-6);
  EXPECT_NEAR(x.state().disturbance_mm_s2, 300.0 + 1.0 * 20.0, 0.5);
}

// From both sides of the border: 2 % below it nothing moves, 10 % above it does.
TEST(AxisServo, BreaksAwayOnlyAboveTheBreakawayForce) {
  // Integral part off: a step smaller than τ·F/k cannot move the axis, a larger one does.
  const double still_mm = 0.004 * 450.0 / 50.0;
  for (const double share : {0.98, 1.10}) {
    auto made = AxisServo::make({.axis = rubbing_axis(), .integral_s = 1e6});
    ASSERT_TRUE(made);
    for (int i = 0; i < 500; ++i) {
      made->update(share * still_mm, 0.0);
    }
    EXPECT_EQ(made->state().motor_mm != 0.0, share > 1.0) << share;
  }
}

// Stiction, count and integral part together make a naive loop hunt; here position and velocity
// must stay the same to the bit.
TEST(AxisServo, RestsWithoutChatterAfterAnyMove) {
  EXPECT_TRUE(rc::check("comes to rest and stays there", [] {
    Axis axis = rubbing_axis();
    axis.encoder.count_au = *rc::gen::element(0.0, 0.0005, 0.001, 0.005);
    axis.velocity_lag_s = *rc::gen::element(0.0, 0.002, 0.006);
    axis.drive_acceleration_au_s2 = *rc::gen::element(3000.0, kernel::machine::kUnlimited);
    axis.friction.breakaway_au_s2 = *rc::gen::inRange(300, 900);
    AxisServo x = servo(axis, *rc::gen::element(0.001, 0.002));
    const double end_mm = *rc::gen::inRange(-2000, 2000) * 1e-3;
    for (int i = 1; i <= 400; ++i) {
      x.update(end_mm * i / 400.0, 0.0);
    }
    for (int i = 0; i < 4000; ++i) {
      x.update(end_mm, 0.0);
    }
    const double rest_mm = x.state().motor_mm;
    RC_ASSERT(std::abs(rest_mm - end_mm) <= std::max(axis.encoder.count_au * 1.5, 5.5e-4));
    for (int i = 0; i < 1000; ++i) {
      x.update(end_mm, 0.0);
      RC_ASSERT(x.state().motor_mm == rest_mm);
      RC_ASSERT(x.state().velocity_mm_s == 0.0);
    }
  }));
}

}  // namespace
}  // namespace steadyrest::sim
