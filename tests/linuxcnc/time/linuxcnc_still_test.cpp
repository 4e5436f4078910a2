// SPDX-License-Identifier: Apache-2.0
// The recorded figures again, measured live where LinuxCNC is installed: they may drift with its
// version.
#include <fstream>
#include <string>

#include <gtest/gtest.h>
#include <tests/linuxcnc/measure.hpp>
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

}  // namespace
}  // namespace steadyrest
