// SPDX-License-Identifier: Apache-2.0
#include <cmath>
#include <limits>
#include <numbers>

#include <gtest/gtest.h>
#include <rapidcheck.h>

#include <steadyrest/sim/panel/spindle_drive.hpp>

namespace steadyrest::sim {
namespace {

using std::numbers::pi;

SpindleDrive drive(const kernel::machine::Spindle& spindle) {
  auto made = SpindleDrive::make({.spindle = spindle});
  EXPECT_TRUE(made);
  return *made;
}

double seconds_to_speed(SpindleDrive& spindle, double command_rev_s, double period_s) {
  for (int i = 1; i < 1000000; ++i) {
    if (spindle.update({.command_rev_s = command_rev_s, .period_s = period_s}).actual_rev_s ==
        command_rev_s) {
      return i * period_s;
    }
  }
  return std::numeric_limits<double>::infinity();
}

// From 80 through 0 to −40 rev/s are 120 rev/s.
TEST(SpindleDrive, RampsWithItsAccelerationLimit) {
  SpindleDrive spindle = drive({.max_rev_s = 100.0,
                                .acceleration_rev_s2 = 50.0,
                                .inertia_kg_m2 = 0.001,
                                .rated_power_w = 1e6,
                                .max_torque_n_m = 1e3});
  EXPECT_NEAR(seconds_to_speed(spindle, 80.0, 0.001), 80.0 / 50.0, 0.0011);
  EXPECT_NEAR(seconds_to_speed(spindle, -40.0, 0.001), 120.0 / 50.0, 0.0011);
}

// Constant torque up to ω_b = P/M, constant power from there; braking is the same in reverse.
TEST(SpindleDrive, TorqueThenPowerLimitTheRunUpAsTheClosedFormSays) {
  const double inertia = 0.05;
  const double torque = 40.0;
  const double power = 5000.0;
  // t = J·ω_b/M + J·(ω² − ω_b²)/(2P), ω_b = P/M
  const double base = power / torque;
  const double omega = 2.0 * pi * 100.0;
  const double truth =
      inertia * base / torque + inertia * (omega * omega - base * base) / (2.0 * power);
  for (const double period_s : {0.0005, 0.004}) {
    SpindleDrive spindle = drive({.max_rev_s = 200.0,
                                  .acceleration_rev_s2 = 1e9,
                                  .inertia_kg_m2 = inertia,
                                  .rated_power_w = power,
                                  .max_torque_n_m = torque});
    EXPECT_NEAR(seconds_to_speed(spindle, 100.0, period_s), truth, period_s * 1.01);
    EXPECT_NEAR(seconds_to_speed(spindle, 0.0, period_s), truth, period_s * 1.01);
  }
}

// Ten short periods and one long one must end alike, including through zero.
TEST(SpindleDrive, ResultDoesNotDependOnThePeriod) {
  const kernel::machine::Spindle s{.max_rev_s = 200.0, .rated_power_w = 2000.0};
  SpindleDrive fine = drive(s);
  SpindleDrive coarse = drive(s);
  for (int i = 0; i < 300; ++i) {
    const double command = i < 150 ? 120.0 : -60.0;
    double last = 0.0;
    for (int j = 0; j < 10; ++j) {
      last = fine.update({.command_rev_s = command, .period_s = 0.001}).actual_rev_s;
    }
    ASSERT_NEAR(coarse.update({.command_rev_s = command, .period_s = 0.010}).actual_rev_s, last,
                1e-9);
  }
}

// Programmed 90 at 120 % is above the largest speed, 1 below the smallest: both are clamped, 0 is
// not.
TEST(SpindleDrive, OverrideScalesAndLimitsHold) {
  SpindleDrive spindle = drive({.max_rev_s = 100.0, .min_rev_s = 2.0});
  EXPECT_EQ(spindle.update({.command_rev_s = 50.0, .override_ratio = 0.8}).target_rev_s, 40.0);
  EXPECT_EQ(spindle.update({.command_rev_s = -90.0, .override_ratio = 1.2}).target_rev_s, -100.0);
  EXPECT_EQ(spindle.update({.command_rev_s = 1.0}).target_rev_s, 2.0);
  EXPECT_EQ(spindle.update({.command_rev_s = 0.0}).target_rev_s, 0.0);
}

// At rest with a command of 0 it is at speed; 10 rev/s at 50 rev/s² take 0.2 s.
TEST(SpindleDrive, SaysWhenItIsAtSpeed) {
  SpindleDrive spindle = drive({.acceleration_rev_s2 = 50.0});
  EXPECT_TRUE(spindle.update({}).at_speed);
  EXPECT_FALSE(spindle.update({.command_rev_s = 10.0}).at_speed);
  for (int i = 0; i < 300; ++i) {
    spindle.update({.command_rev_s = 10.0});
  }
  EXPECT_TRUE(spindle.update({.command_rev_s = 10.0}).at_speed);
}

// Rate, torque 2πJ·ṅ and power 2π²J·Δ(n²)/h measured from outside, in every millisecond.
TEST(SpindleDrive, NeverPassesTorquePowerOrRamp) {
  EXPECT_TRUE(rc::check("limits hold for any command", [] {
    const kernel::machine::Spindle s{.max_rev_s = 150.0,
                                     .acceleration_rev_s2 = *rc::gen::inRange(5, 500) * 1.0,
                                     .inertia_kg_m2 = *rc::gen::inRange(1, 100) * 1e-3,
                                     .rated_power_w = *rc::gen::inRange(100, 20000) * 1.0,
                                     .max_torque_n_m = *rc::gen::inRange(1, 100) * 1.0};
    SpindleDrive spindle = drive(s);
    const double h = 0.001;
    double before = 0.0;
    for (int i = 0; i < 20; ++i) {
      const double command = *rc::gen::inRange(-150, 150) * 1.0;
      for (int j = 0; j < 50; ++j) {
        const double now = spindle.update({.command_rev_s = command, .period_s = h}).actual_rev_s;
        const double rate = std::abs(now - before) / h;
        const double energy =
            2.0 * pi * pi * s.inertia_kg_m2 * std::abs(now * now - before * before) / h;
        RC_ASSERT(rate <= s.acceleration_rev_s2 * (1.0 + 1e-9));
        RC_ASSERT(2.0 * pi * s.inertia_kg_m2 * rate <= s.max_torque_n_m * (1.0 + 1e-9));
        RC_ASSERT(energy <= s.rated_power_w * (1.0 + 1e-9));
        before = now;
      }
    }
  }));
}

TEST(SpindleDrive, RefusesAbsurdDrives) {
  EXPECT_FALSE(SpindleDrive::make({.spindle = {.max_rev_s = 0.0}}));
  EXPECT_FALSE(SpindleDrive::make({.spindle = {.max_rev_s = 10.0, .min_rev_s = 20.0}}));
  EXPECT_FALSE(SpindleDrive::make({.spindle = {.inertia_kg_m2 = 0.0}}));
  EXPECT_FALSE(SpindleDrive::make({.spindle = {.acceleration_rev_s2 = -1.0}}));
  EXPECT_FALSE(
      SpindleDrive::make({.spindle = {.rated_power_w = std::numeric_limits<double>::quiet_NaN()}}));
}

}  // namespace
}  // namespace steadyrest::sim
