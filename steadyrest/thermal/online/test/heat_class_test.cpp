// SPDX-License-Identifier: Apache-2.0
// Which work counts as which heat: the model's closed form over what the frames showed.
#include <cmath>

#include <gtest/gtest.h>

#include <steadyrest/kernel/units/constants.hpp>
#include <steadyrest/thermal/online/test/governed.hpp>

namespace steadyrest::thermal::online {
namespace {

using kernel::outcome::Reason;
using kernel::signal::Motion;
using test::Governed;
using test::kLevel_mm;
using test::kTau_s;
using test::kX;
using test::kZ;

constexpr double kCut = 1.5;
constexpr double kWet = 0.6;

/// Cutting makes half as much heat again, coolant leaves six tenths of it.
kernel::machine::Machine heated() {
  auto machine = test::mill();
  machine.thermal.axis[0].mode[0].cutting_ratio = kCut;
  machine.thermal.axis[0].mode[0].coolant_ratio = kWet;
  return machine;
}

/// Displacement after `s` seconds at 50 rev/s, as a share of the level due to speed alone.
double share_after(Governed& on, double s) {
  const double z_mm = on.seconds(s).displacement_mm[kZ];
  return z_mm / (0.5 * kLevel_mm * (1.0 - std::exp(-s / kTau_s)));
}

// Feed, thread and tap cut; nothing else does. The first 0.1 s pass before the first frame.
TEST(HeatClass, ThreadsAndTapsCutAsFeedDoes) {
  for (const Motion motion : {Motion::feed, Motion::thread, Motion::tap}) {
    Governed on(heated());
    on.frame.motion = motion;
    EXPECT_NEAR(share_after(on, 300.0), kCut, 0.01) << static_cast<int>(motion);
  }
  for (const Motion motion : {Motion::idle, Motion::rapid, Motion::probe, Motion::dwell,
                              Motion::tool_change, Motion::spindle_wait}) {
    Governed on(heated());
    on.frame.motion = motion;
    EXPECT_NEAR(share_after(on, 300.0), 1.0, 0.01) << static_cast<int>(motion);
  }
}

// Coolant alone, and with cutting: the ratios multiply.
TEST(HeatClass, CoolantActsWithAndWithoutTheCut) {
  Governed air(heated());
  air.frame.motion = Motion::rapid;
  air.frame.coolant = true;
  EXPECT_NEAR(share_after(air, 300.0), kWet, 0.01);
  Governed cut(heated());
  cut.frame.coolant = true;
  EXPECT_NEAR(share_after(cut, 300.0), kWet * kCut, 0.01);
}

// Alternating 0.3 s of cut and 0.4 s of air: much shorter than the filters' one second, yet each
// counts for its full time. The mean of the levels is (0.3·1.5 + 0.4)/0.7.
TEST(HeatClass, ChangesWithinASecondCountForAsLongAsTheyLast) {
  Governed on(heated());
  for (int i = 0; i < 4200; ++i) {
    on.frame.motion = i % 7 < 3 ? Motion::feed : Motion::rapid;
    on.cycle();
  }
  const double passed_s = 420.0;
  const double alone_mm = 0.5 * kLevel_mm * (1.0 - std::exp(-passed_s / kTau_s));
  EXPECT_NEAR(on.governor.output().displacement_mm[kZ] / alone_mm, (0.3 * kCut + 0.4) / 0.7, 0.01);
}

// Alternating 20 and 40 mm/s heat like 30: 0.5 µm for each mm/s on top of the speed's 20 µm.
TEST(HeatClass, TheFeedHeatsByItsMean) {
  auto machine = test::mill();
  machine.thermal.axis[0].mode[0].feed_s = 0.0005;
  Governed on(machine);
  for (int i = 0; i < 3000; ++i) {
    on.frame.path_speed_mm_s = i % 2 == 0 ? 20.0 : 40.0;
    on.cycle();
  }
  const double grown = 1.0 - std::exp(-300.0 / kTau_s);
  EXPECT_NEAR(on.governor.output().displacement_mm[kZ] / grown, 0.5 * kLevel_mm + 0.0005 * 30.0,
              2e-4);
}

// Backwards as forwards: heat knows no direction.
TEST(HeatClass, ASpindleThatTurnsLeftHeatsAsMuch) {
  Governed right;
  Governed left;
  left.frame.spindle_actual_rev_s = -50.0;
  EXPECT_EQ(left.seconds(100.0).displacement_mm[kZ], right.seconds(100.0).displacement_mm[kZ]);
}

// Where the zero was set nothing is off; a reading of 4 µm there is 4 µm more than the model had,
// whatever the growth and the offset in force.
TEST(Rezero, CountsFromWhereTheZeroWasSet) {
  Governed on;
  on.seconds(600.0);
  on.governor.zero_here();
  const double grown_mm = on.governor.output().displacement_mm[kZ];
  ASSERT_LT(on.offset_mm()[kZ], -0.005);
  on.governor.rezero(kZ, {.displacement_mm = 0.004, .sd_mm = 1e-6});
  EXPECT_NEAR(on.look().displacement_mm[kZ], grown_mm + 0.004, 2e-5);
}

TEST(Reset, IsColdAndAsksForNothing) {
  Governed on;
  on.seconds(600.0);
  on.governor.reset();
  EXPECT_FALSE(on.governor.state().started);
  EXPECT_EQ(on.governor.output().displacement_mm, kernel::signal::AxisValues{});
  EXPECT_EQ(on.governor.output().request.offset_mm, kernel::signal::AxisValues{});
  EXPECT_EQ(on.cycle().displacement_mm[kZ], 0.0) << "the first frame only says when it is";
}

// One reason is shown for all axes. X has lost its sensor while Z goes through each of its states:
// the more serious one is named, whichever axis it is on.
TEST(ShownReason, IsTheGravestOfAllAxes) {
  Governed on;
  on.frame.temperature_c[0] = 23.0;
  on.seconds(60.0);
  EXPECT_EQ(on.look().request.reason, Reason::thermal_correcting);
  on.frame.motion = Motion::probe;
  EXPECT_EQ(on.seconds(2.0).request.reason, Reason::thermal_held);
  on.frame.motion = Motion::feed;
  on.frame.spindle_actual_rev_s = 130.0;
  EXPECT_EQ(on.seconds(2.0).request.reason, Reason::thermal_beyond_speed) << "Z, and X corrects";
  on.frame.temperature_c[0] = kernel::units::kNan;
  EXPECT_EQ(on.seconds(2.0).request.reason, Reason::thermal_sensor_lost) << "X before Z's speed";
  on.frame.temperature_c[0] = 70.0;
  EXPECT_EQ(on.seconds(2.0).request.reason, Reason::thermal_sensor_wild);
}

// 3 K at 2 µm/K are 6 µm; at 10 µm/min the offset takes 36 s, and the reason says so.
TEST(ShownReason, IsFollowingUntilTheOffsetIsThere) {
  Governed on;
  on.frame.spindle_actual_rev_s = 0.0;
  on.frame.temperature_c[0] = 20.0;
  on.seconds(1.0);
  on.frame.temperature_c[0] = 23.0;
  EXPECT_EQ(on.seconds(30.0).request.reason, Reason::thermal_following);
  const auto there = on.seconds(10.0);
  EXPECT_EQ(there.request.reason, Reason::thermal_correcting);
  EXPECT_NEAR(there.offset_mm[kX], -0.006, 1e-9);
}

}  // namespace
}  // namespace steadyrest::thermal::online
