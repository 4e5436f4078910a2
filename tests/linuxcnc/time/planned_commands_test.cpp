// SPDX-License-Identifier: Apache-2.0
// The planner's commands against LinuxCNC's, by what a servo makes of both. The recorded figures
// come from scripts that share no code with this project.
#include <algorithm>
#include <string>

#include <gtest/gtest.h>
#include <tests/linuxcnc/time/measured_programs.hpp>
#include <tests/linuxcnc/time/servo_on_commands.hpp>

namespace steadyrest {
namespace {

using linuxcnc_test::Cut;
using linuxcnc_test::MeasuredProgram;

constexpr double kShare = 0.05;
constexpr double kLeast_um = 1.0;

TEST(PlannedCommands, LeaveAServoTheErrorThatLinuxCncsCommandsLeaveIt) {
  for (const MeasuredProgram& p : linuxcnc_test::measured_programs()) {
    const Cut cut = linuxcnc_test::cut_by(linuxcnc_test::planned_commands(p.text),
                                          linuxcnc_test::programmed_path(p.text));
    EXPECT_NEAR(cut.seconds, p.cut_s, linuxcnc_test::kWorst * p.cut_s) << p.name;
    EXPECT_NEAR(cut.rms_k20_um, p.rms_k20_um, std::max(kLeast_um, kShare * p.rms_k20_um)) << p.name;
    EXPECT_NEAR(cut.rms_k50_um, p.rms_k50_um, std::max(kLeast_um, kShare * p.rms_k50_um)) << p.name;
  }
}

}  // namespace
}  // namespace steadyrest
