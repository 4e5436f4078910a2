// SPDX-License-Identifier: Apache-2.0
#include <cmath>

#include <gtest/gtest.h>

#include <steadyrest/kernel/units/constants.hpp>
#include <steadyrest/thermal/online/test/governed.hpp>

namespace steadyrest::thermal::online {
namespace {

using kernel::outcome::Reason;
using kernel::signal::Motion;
using kernel::units::kNan;
using test::Governed;
using test::kX;
using test::kZ;
using test::mill;

TEST(OffsetGovernor, ALostSensorHoldsItsAxisInTheCutAndFadesOutOfIt) {
  Governed on;
  on.frame.temperature_c[0] = 23.0;
  on.seconds(60.0);
  on.frame.temperature_c[0] = kNan;
  EXPECT_EQ(on.seconds(300.0).request.reason, Reason::thermal_sensor_lost);
  EXPECT_NEAR(on.offset_mm()[kX], -0.006, 1e-12);
  EXPECT_LT(on.offset_mm()[kZ], -0.006) << "the other axis goes on";
  on.tool_in_cut = false;
  on.frame.motion = Motion::rapid;
  // 18 s at 10 µm/min are 3 of the 6 µm.
  on.seconds(18.0);
  EXPECT_NEAR(on.offset_mm()[kX], -0.003, 1e-4) << "10 µm/min";
  on.seconds(60.0);
  EXPECT_EQ(on.offset_mm()[kX], 0.0);
  on.frame.temperature_c[0] = 23.0;
  EXPECT_NEAR(on.seconds(60.0).offset_mm[kX], -0.006, 1e-12);
}

// A plan in the program's text takes the drift away already.
TEST(OffsetGovernor, CorrectionsInTheTextKeepItsOffsetOut) {
  Governed on;
  on.frame.temperature_c[0] = 23.0;
  on.frame.heat_in_text = true;
  EXPECT_EQ(on.seconds(300.0).request.reason, Reason::thermal_in_text);
  EXPECT_EQ(on.offset_mm()[kX], 0.0);
  on.frame.heat_in_text = false;
  on.seconds(120.0);
  EXPECT_NEAR(on.offset_mm()[kX], -0.006, 1e-9) << "the next program";
  on.frame.heat_in_text = true;
  on.seconds(300.0);
  EXPECT_NEAR(on.offset_mm()[kX], -0.006, 1e-9) << "held in the cut";
  on.tool_in_cut = false;
  on.frame.motion = Motion::rapid;
  on.seconds(120.0);
  EXPECT_EQ(on.offset_mm()[kX], 0.0);
}

// At the retract slope a second of NaN would remove the whole offset, and the next cut would miss
// it.
TEST(OffsetGovernor, ASensorThatFailsForASecondOutOfTheCutDoesNotTakeTheOffsetAway) {
  auto machine = mill();
  machine.thermal.retract_slope_mm_s = 0.010;
  Governed on(machine);
  on.frame.temperature_c[0] = 23.0;
  on.seconds(60.0);
  on.tool_in_cut = false;
  on.frame.motion = Motion::rapid;
  on.frame.temperature_c[0] = kNan;
  EXPECT_NEAR(on.seconds(1.0).offset_mm[kX], -0.006, 2e-4);
  on.frame.temperature_c[0] = 23.0;
  EXPECT_NEAR(on.seconds(0.2).offset_mm[kX], -0.006, 1e-12);
}

TEST(OffsetGovernor, AWildSensorHoldsItsAxisInTheCutAndFadesOutOfIt) {
  test::Governed on;
  on.frame.temperature_c[0] = 23.0;
  on.seconds(60.0);
  const double before = on.governor.output().displacement_mm[test::kX];
  on.frame.temperature_c[0] = 60.0;
  EXPECT_EQ(on.seconds(300.0).request.reason, Reason::thermal_sensor_wild);
  EXPECT_EQ(on.governor.output().displacement_mm[test::kX], before) << "the model has not seen it";
  EXPECT_NEAR(on.offset_mm()[test::kX], -0.006, 1e-12);
  EXPECT_LT(on.offset_mm()[test::kZ], -0.006) << "the other axis goes on";
  on.tool_in_cut = false;
  on.frame.motion = Motion::rapid;
  EXPECT_EQ(on.seconds(60.0).offset_mm[test::kX], 0.0);
  on.frame.temperature_c[0] = 23.5;
  EXPECT_NEAR(on.seconds(60.0).offset_mm[test::kX], -0.007, 1e-12);
}

TEST(OffsetGovernor, AStuckSensorIsAsOneThatIsLost) {
  auto machine = test::mill();
  machine.thermal.axis[0].ambient.push_back({.sensor = "column", .gain_mm_k = 0.001});
  test::Governed on(machine);
  on.frame.temperature_c[1] = 21.373;
  const auto hours = [&](double h) {
    for (int i = 0; i < static_cast<int>(h * 120.0); ++i) {
      on.frame.time_s += 30.0;
      // The governor's order: Z's sensor is named first.
      on.frame.temperature_c[0] = 22.0 + 2.0 * std::sin(on.frame.time_s / 2000.0);
      on.look();
    }
    return on.governor.output().request.reason;
  };
  EXPECT_NE(hours(1.5), Reason::thermal_sensor_stuck);
  EXPECT_EQ(hours(4.0), Reason::thermal_sensor_stuck);
  test::Governed restarted(machine);
  restarted.governor.restore(on.governor.state());
  restarted.frame = on.frame;
  EXPECT_EQ(restarted.cycle().request.reason, Reason::thermal_sensor_stuck);
}

}  // namespace
}  // namespace steadyrest::thermal::online
