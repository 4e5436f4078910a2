// SPDX-License-Identifier: Apache-2.0
// The recorded figures again, measured live where LinuxCNC is installed: they may drift with its
// version.
#include <fstream>
#include <string>

#include <gtest/gtest.h>
#include <tests/linuxcnc/measure.hpp>
#include <tests/linuxcnc/time/measured_programs.hpp>
#include <tests/linuxcnc/time/servo_on_commands.hpp>
#include <tests/linuxcnc/time/timed_programs.hpp>

#include <steadyrest/kernel/file/testing/own_folder.hpp>

namespace steadyrest {
namespace {

using linuxcnc_test::Case;
using linuxcnc_test::kWorst;

TEST(ProgramTimeAgainstLinuxCnc, LinuxCncStillTakesAsLong) {
  const kernel::file::testing::OwnFolder folder;
  for (const Case& c : linuxcnc_test::own_programs()) {
    const std::string program = folder.file(std::string(c.name) + ".ngc", c.text);
    const double planned_s = linuxcnc_test::planned_s(c.text);
    const auto ran = linuxcnc_test::run_planned(program, folder.at("log"), planned_s);
    if (ran.status == linuxcnc_test::kCannotRun) {
      GTEST_SKIP() << "LinuxCNC is not installed or namespaces are not permitted";
    }
    ASSERT_EQ(ran.status, 0) << c.name;
    EXPECT_NEAR(planned_s, ran.seconds, kWorst * ran.seconds) << c.name;
  }
}

// Short ones of those in planned_commands_test: kinks between lines and arcs, a stop at each
// corner, lines in space.
TEST(PlannedCommands, LinuxCncStillGivesSuchCommands) {
  const kernel::file::testing::OwnFolder folder;
  for (const auto& text :
       {linuxcnc_test::programs::lines_and_arcs("G64"), linuxcnc_test::programs::star("G61"),
        linuxcnc_test::programs::wave_in_space("G64 P0.01 Q0.005")}) {
    const std::string program = folder.file("program.ngc", text);
    const auto path = linuxcnc_test::programmed_path(text);
    const auto planned = linuxcnc_test::planned_commands(text);
    const double whole_s = 0.001 * static_cast<double>(planned.size());
    const auto ran = linuxcnc_test::run_planned(program, folder.at("log"), whole_s);
    if (ran.status == linuxcnc_test::kCannotRun) {
      GTEST_SKIP() << "LinuxCNC is not installed or namespaces are not permitted";
    }
    ASSERT_EQ(ran.status, 0) << text;
    const auto real = linuxcnc_test::cut_by(linuxcnc_test::logged_commands(folder.at("log")), path);
    const auto ours = linuxcnc_test::cut_by(planned, path);
    EXPECT_NEAR(ours.seconds, real.seconds, kWorst * real.seconds) << text;
    EXPECT_NEAR(ours.rms_k20_um, real.rms_k20_um, 0.05 * real.rms_k20_um) << text;
    EXPECT_NEAR(ours.rms_k50_um, real.rms_k50_um, 0.05 * real.rms_k50_um) << text;
  }
}

}  // namespace
}  // namespace steadyrest
