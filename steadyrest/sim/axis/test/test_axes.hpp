// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <gtest/gtest.h>

#include <steadyrest/sim/axis/axis_servo.hpp>

/// Axes that the servo's tests drive.
namespace steadyrest::sim::test {

inline kernel::machine::Axis ideal_axis(double gain_1_s) {
  kernel::machine::Axis axis;
  axis.servo_gain_1_s = gain_1_s;
  axis.encoder.count_au = 0.0;
  return axis;
}

inline AxisServo servo(const kernel::machine::Axis& axis, double period_s = 0.001) {
  auto made = AxisServo::make({.axis = axis, .period_s = period_s});
  EXPECT_TRUE(made) << (made ? "" : made.error().what);
  return *made;
}

inline kernel::machine::Axis rubbing_axis() {
  kernel::machine::Axis axis = ideal_axis(50.0);
  axis.velocity_lag_s = 0.004;
  axis.friction = {
      .coulomb_au_s2 = 300.0, .breakaway_au_s2 = 450.0, .stribeck_au_s = 2.0, .viscous_1_s = 1.0};
  return axis;
}

}  // namespace steadyrest::sim::test
