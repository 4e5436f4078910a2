// SPDX-License-Identifier: Apache-2.0
#include <string>
#include <vector>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <steadyrest/adapters/linuxcnc/config/machine_differences.hpp>

namespace steadyrest::adapters::linuxcnc::config {
namespace {

using kernel::machine::Axis;
using kernel::machine::Machine;
using testing::AllOf;
using testing::HasSubstr;
using testing::IsEmpty;

const std::string kIni =
    "[EMCMOT]\nSERVO_PERIOD = 1000000\n[KINS]\nJOINTS = 3\nKINEMATICS = trivkins coordinates=XZA\n"
    "[TRAJ]\nCOORDINATES = X Z A\nLINEAR_UNITS = inch\nMAX_LINEAR_VELOCITY = "
    "3\nMAX_LINEAR_ACCELERATION = 30\nANGULAR_UNITS = degree\n"
    "[AXIS_X]\nMAX_VELOCITY = 2\nMAX_ACCELERATION = 20\nMIN_LIMIT = -1\nMAX_LIMIT = 10\n"
    "[JOINT_0]\nTYPE = LINEAR\n"
    "[AXIS_Z]\nMAX_VELOCITY = 1\nMAX_ACCELERATION = 10\nMIN_LIMIT = -4\nMAX_LIMIT = 0\n"
    "[JOINT_1]\nTYPE = LINEAR\n"
    "[AXIS_A]\nMAX_VELOCITY = 90\nMAX_ACCELERATION = 900\n[JOINT_2]\nTYPE = ANGULAR\n"
    "[SPINDLE_0]\nMAX_FORWARD_VELOCITY = 6000\n";

Axis axis(const std::string& name, double speed_au_s, double acceleration_au_s2, double min_au,
          double max_au) {
  Axis out;
  out.name = name;
  out.max_speed_au_s = speed_au_s;
  out.max_acceleration_au_s2 = acceleration_au_s2;
  out.min_au = min_au;
  out.max_au = max_au;
  return out;
}

/// The machine of kIni, in mm and rad; Y is a placeholder.
Machine machine() {
  Machine out;
  out.control.servo_period_s = out.control.interpolator_period_s = 0.001;
  out.control.max_path_acceleration_mm_s2 = 762.0;
  out.control.max_feed_mm_s = 76.2;
  out.spindle.max_rev_s = 100.0;
  out.axes = {axis("X", 50.8, 508.0, -25.4, 254.0), axis("Y", 1.0, 1.0, 0.0, 0.0),
              axis("Z", 25.4, 254.0, -101.6, 0.0), axis("A", 1.5, 15.0, -1e6, 1e6)};
  out.axes[1].present = false;
  out.axes[3].rotary = true;
  return out;
}

std::vector<Difference> found(const Machine& machine) {
  const auto ini = IniFile::parse(kIni, "mill.ini").value();
  return differences(ini, configuration_of(ini).value(), machine);
}

TEST(MachineDifferences, NoneForTheMachineOfTheConfiguration) {
  EXPECT_THAT(found(machine()), IsEmpty());
}

TEST(MachineDifferences, OtherAxesAnotherOrderOrKindAreNamed) {
  std::vector<Machine> others(3, machine());
  others[0].axes.pop_back();
  std::swap(others[1].axes[0], others[1].axes[2]);
  others[2].axes[3].rotary = false;
  const std::vector<std::string> ours = {"the axes X, Z, LinuxCNC has X, Z, rotary A",
                                         "the axes Z, X, rotary A, LinuxCNC",
                                         "the axes X, Z, A, LinuxCNC"};
  for (std::size_t i = 0; i < others.size(); ++i) {
    const auto all = found(others[i]);
    ASSERT_EQ(all.size(), 1U) << ours[i];
    EXPECT_THAT(all[0].what, AllOf(HasSubstr(ours[i]), HasSubstr("mill.ini")));
  }
}

TEST(MachineDifferences, AnotherServoPeriodIsNamed) {
  Machine other = machine();
  other.control.servo_period_s = 0.002;
  const auto all = found(other);
  ASSERT_EQ(all.size(), 1U);
  EXPECT_EQ(all[0].to_do, "set servo_period_ms = 1");
}

TEST(MachineDifferences, AnotherInterpolatorPeriodIsNamed) {
  Machine other = machine();
  other.control.interpolator_period_s = 0.002;
  const auto all = found(other);
  ASSERT_EQ(all.size(), 1U);
  EXPECT_EQ(all[0].to_do, "set interpolator_period_ms = 1");
}

TEST(MachineDifferences, LimitsAlongThePathAreNamed) {
  Machine other = machine();
  other.control.max_path_acceleration_mm_s2 = 3000.0;
  other.control.max_feed_mm_s = 100.0;
  const auto all = found(other);
  ASSERT_EQ(all.size(), 2U);
  EXPECT_THAT(all[0].what, AllOf(HasSubstr("3000 mm/s²"), HasSubstr("762")));
  EXPECT_THAT(all[0].what, testing::StartsWith("the path acceleration 3000"));
  EXPECT_THAT(all[1].what, HasSubstr("[TRAJ] MAX_LINEAR_VELOCITY = 3"));
}

TEST(MachineDifferences, APathLimitThatTheMachineFileLacksIsNamedByItsKey) {
  Machine other = machine();
  other.control.max_path_acceleration_mm_s2 = kernel::machine::kUnlimited;
  other.control.max_feed_mm_s = kernel::machine::kUnlimited;
  const auto all = found(other);
  ASSERT_EQ(all.size(), 2U);
  EXPECT_EQ(all[0].what,
            "the machine file sets no max_path_acceleration_mm_s2; the control's is 762 mm/s² "
            "([TRAJ] MAX_LINEAR_ACCELERATION = 30)");
  EXPECT_EQ(all[0].to_do, "set max_path_acceleration_mm_s2 = 762, or less");
  EXPECT_THAT(all[1].what, HasSubstr("sets no max_feed_mm_min; the control's is 76.2 mm/s"));
  EXPECT_EQ(all[1].to_do, "set max_feed_mm_min = 4572, or less");
}

TEST(MachineDifferences, AFasterSpindleIsNamed) {
  Machine other = machine();
  other.spindle.max_rev_s = 200.0;
  const auto all = found(other);
  ASSERT_EQ(all.size(), 1U);
  EXPECT_THAT(all[0].what, AllOf(HasSubstr("12000 rpm"), HasSubstr("6000"),
                                 HasSubstr("[SPINDLE_0] MAX_FORWARD_VELOCITY = 6000")));
  EXPECT_EQ(all[0].to_do, "set max_rpm = 6000, or less");
}

TEST(MachineDifferences, LimitsBeyondTheControlsAreNamed) {
  Machine other = machine();
  other.axes[0].max_speed_au_s = 60.0;
  other.axes[2].max_acceleration_au_s2 = 300.0;
  other.axes[2].max_au = 5.0;
  other.axes[3].max_speed_au_s = 3.0;
  const auto all = found(other);
  ASSERT_EQ(all.size(), 4U);
  EXPECT_THAT(all[0].what, AllOf(HasSubstr("axis X: speed 60 mm/s"), HasSubstr("50.8"),
                                 HasSubstr("[AXIS_X] MAX_VELOCITY = 2")));
  EXPECT_THAT(all[1].what, HasSubstr("axis Z: acceleration 300"));
  EXPECT_THAT(all[2].what, HasSubstr("axis Z: upper end of travel 5 mm"));
  EXPECT_THAT(all[3].what, AllOf(HasSubstr("axis A: speed 171.887 °/s"), HasSubstr("90")));
}

// A machine file may hold back what the control permits.
TEST(MachineDifferences, TighterLimitsAreNone) {
  Machine other = machine();
  other.axes[0].max_speed_au_s = 20.0;
  other.axes[0].min_au = 0.0;
  other.axes[0].max_au = 100.0;
  EXPECT_THAT(found(other), IsEmpty());
}

TEST(MachineDifferences, WhatALayerTakesOverAtItsStartAloneIsNamed) {
  const Machine running = machine();
  EXPECT_FALSE(changed_since_start(running, running));
  Machine other = running;
  other.contour.limit_mm *= 2.0;
  other.axes[0].servo_gain_1_s *= 2.0;
  EXPECT_FALSE(changed_since_start(running, other));
  std::vector<Machine> others(4, running);
  others[0].envelope.offset_slew_mm_s *= 0.5;
  others[1].control.corner_tolerance_mm = 0.5;
  others[2].axes[2].max_speed_au_s *= 0.5;
  others[3].axes[0].max_acceleration_au_s2 *= 0.5;
  const std::vector<std::string> words = {"[envelope] offset_slew_um_s", "[control]", "an axis's",
                                          "an axis's"};
  for (std::size_t i = 0; i < others.size(); ++i) {
    const auto changed = changed_since_start(running, others[i]);
    ASSERT_TRUE(changed) << words[i];
    EXPECT_THAT(changed->what, testing::StartsWith(words[i]));
    EXPECT_EQ(changed->to_do, "stop the layer and start it with the new file");
  }
}

}  // namespace
}  // namespace steadyrest::adapters::linuxcnc::config
