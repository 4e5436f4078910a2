// SPDX-License-Identifier: Apache-2.0
#include <cmath>
#include <numbers>
#include <string>

#include <fmt/core.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <steadyrest/kernel/override/test/published_tables.hpp>
#include <steadyrest/nc/interpret/program.hpp>
#include <steadyrest/nc/plan/path/path_builder.hpp>
#include <steadyrest/sim/cut/cutting_vibration.hpp>
#include <steadyrest/trial/cut/chatter_choice.hpp>
#include <steadyrest/trial/listener/listener.hpp>

namespace steadyrest::trial::cut {
namespace {

using listener::with_modulator;

namespace machine = kernel::machine;
using ::testing::HasSubstr;

nc::plan::PlannedPath path_of(const std::string& program) {
  machine::Machine m;
  m.axes.resize(3);
  m.axes[1].name = "Y";
  m.axes[2].name = "Z";
  m.spindle.max_rev_s = 100.0;
  nc::plan::PathBuilder builder(m);
  nc::interpret::Config control;
  control.axes = "XYZ";
  const auto report = nc::interpret::run_text(program, control, builder);
  EXPECT_TRUE(report && report->refused.empty());
  return builder.take().value();
}

/// Two diameters at a constant cutting speed, a drilled centre, a face at a constant cutting speed.
const std::string kTurned =
    "G21 G90 G18\n"
    "G0 X30 Z2\n"
    "G96 S120 M3\n"
    "G1 Z-40 F100\n"  // line 4, radius 30
    "G0 X20 Z2\n"     // not in the cut
    "G1 Z-40 F100\n"  // line 6, radius 20
    "G97 S1500\n"
    "G0 X0 Z2\n"
    "G1 Z-10 F100\n"  // line 9, planned
    "G0 Z2\n"
    "G96 S120\n"
    "G0 X40\n"
    "G1 X10 F100\n"  // line 13, mean radius 25
    "M2\n";

int rpm_at_radius(double radius_mm) {
  return static_cast<int>(std::lround(120e3 / (2.0 * std::numbers::pi * radius_mm)));
}

TEST(UnplannedCuts, AreTheStretchesUnderConstantCuttingSpeedByLine) {
  const auto path = path_of(kTurned);
  EXPECT_EQ(cutting_speeds(path), std::vector<double>{25.0});
  const auto warnings = unplanned_cuts(path);
  ASSERT_EQ(warnings.size(), 2U);
  EXPECT_EQ(warnings[0].line, 4U);
  EXPECT_THAT(warnings[0].text, HasSubstr("up to line 6 "));
  EXPECT_THAT(warnings[0].text,
              HasSubstr(fmt::format("{} … {} rpm", rpm_at_radius(30.0), rpm_at_radius(20.0))));
  EXPECT_EQ(warnings[1].line, 13U);
  EXPECT_THAT(warnings[1].text,
              HasSubstr(fmt::format("{} … {} rpm", rpm_at_radius(25.0), rpm_at_radius(25.0))));
}

TEST(UnplannedCuts, AreNoneAtProgrammedSpeeds) {
  EXPECT_TRUE(unplanned_cuts(path_of("G21 G90 S1500 M3\nG1 X10 F100\nG1 X0\nM2\n")).empty());
}

machine::Machine mill_down_to(double least_ratio) {
  machine::Machine m;
  m.spindle_override = kernel::override::test::spindle_840d();
  m.spindle_override.ratio = {least_ratio, 0.5, 1.0, 1.2};
  m.envelope.min_spindle_ratio = least_ratio;
  return m;
}

TEST(LeastSpindleRatio, IsTheEnvelopesForAListenerNotAHalf) {
  EXPECT_DOUBLE_EQ(least_spindle_ratio({}, true, with_modulator(mill_down_to(0.2))), 0.2);
  EXPECT_DOUBLE_EQ(least_spindle_ratio({}, true, with_modulator(mill_down_to(0.7))), 0.7);
  EXPECT_DOUBLE_EQ(least_spindle_ratio({}, false, mill_down_to(0.2)), 1.0);
  // An envelope that permits a stop: the switch's lowest speed is the minimum.
  machine::Machine m = mill_down_to(0.3);
  m.envelope.min_spindle_ratio = 0.0;
  m.spindle_override.ratio.insert(m.spindle_override.ratio.begin(), 0.0);
  EXPECT_DOUBLE_EQ(least_spindle_ratio({}, true, m), 0.3);
}

TEST(LeastSpindleRatio, IsTheLowestThatLawOrMachineFileAsksFor) {
  ChatterChoice law;
  law.modulation = {.law = chatter::online::Law::sine, .amplitude_ratio = 0.4, .mean_ratio = 0.5};
  EXPECT_DOUBLE_EQ(least_spindle_ratio({law}, false, with_modulator(mill_down_to(0.2))), 0.3);
  machine::Machine own = mill_down_to(0.2);
  own.chatter.enabled = true;
  own.chatter.mean_ratio = 0.8;
  own.chatter.amplitude_ratio = 0.5;
  EXPECT_DOUBLE_EQ(least_spindle_ratio({}, false, own), 0.4);
  own.chatter.amplitude_rev_s = 5.0;
  EXPECT_DOUBLE_EQ(least_spindle_ratio({}, false, own), 0.2);
}

// The purpose: the simulated cut follows the spindle down to half of the speed that its grid is
// made for, and cuts nothing below that.
TEST(LeastSpindleRatio, TheSimulatedCutFollowsTheSpindleDownToIt) {
  const double programmed_rev_s = 80.0;
  const machine::Machine m = with_modulator(mill_down_to(0.2));
  sim::CuttingVibration::Config config;
  config.cut.modes = {{.frequency_hz = 922.0, .damping_ratio = 0.011, .mass_kg = 0.03993}};
  config.cut.depth_mm = 0.1;
  config.slowest_rev_s = programmed_rev_s * least_spindle_ratio({}, true, m);
  auto vibration = sim::CuttingVibration::make(config).value();
  vibration.begin_cycle();
  vibration.advance({.period_s = 0.01,
                     .speed_rev_s = 0.2 * programmed_rev_s,
                     .path_speed_mm_s = 5.0,
                     .in_cut = true});
  EXPECT_NEAR(vibration.cycle().cutting_s, 0.01, 1e-3);
}

}  // namespace
}  // namespace steadyrest::trial::cut
