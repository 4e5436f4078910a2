// SPDX-License-Identifier: Apache-2.0
#include <cstdlib>
#include <string>

#include "expectations.hpp"
#include "program.hpp"
#include "scratch.hpp"
#include <gmock/gmock.h>
#include <gtest/gtest.h>

// Modules in place of LinuxCNC's say what a control would say.
namespace steadyrest::test {
namespace {

using ::testing::HasSubstr;
using ::testing::Not;

class LinuxCncStart : public ::testing::Test {
 protected:
  LinuxCncStart() { ::setenv("PYTHONPATH", scratch.at("").c_str(), 1); }
  ~LinuxCncStart() override { ::unsetenv("PYTHONPATH"); }

  /// What `run` says on a control that has this INI file.
  [[nodiscard]] Finished run_on(const std::string& ini) const {
    const std::string zeros = "[0,0,0,0,0,0,0,0,0]";
    const std::string state =
        R"({"version":"2.9.4","ini":")" + scratch.file("mill.ini", ini) +
        R"(","program":"","text_is_file":true,"stopped":true,"position":)" + zeros +
        R"(,"work_offset":1,"work_offset_mm":)" + zeros + R"(,"rotation_deg":0,"g92_mm":)" + zeros +
        R"(,"tool_offset_mm":)" + zeros +
        R"(,"tool":0,"tools":[],"block_delete":false,"inch":false,"incremental":false,)"
        R"("plane":"xy","retract_to_initial":true,"centre_absolute":false,"selected_tool":null,)"
        R"("unread":"","path_mode":"continuous","path_tolerance_mm":0,"machine_inch":false,)"
        R"("variables":"","folders":[]})";
    (void)scratch.file("hal.py", "");
    (void)scratch.file("linuxcnc.py",
                       "import time\nprint('''" + state + "''', flush=True)\ntime.sleep(60)\n");
    std::string machine = text_of_file(project_file("examples/machines/linuxcnc-mill.toml"));
    const std::string sim = "port = \"sim\"";
    machine.replace(machine.find(sim), sim.size(), "port = \"linuxcnc\"");
    return run_line("run --machine " + scratch.file("machine.toml", machine) + " --socket " +
                    scratch.at("s"));
  }

  Scratch scratch;
};

TEST_F(LinuxCncStart, RefusesAConfigurationThatTheLayerCannotWorkOn) {
  const auto said = run_on("[KINS]\nKINEMATICS = scarakins\nJOINTS = 3\n");
  EXPECT_EQ(said.code, 2) << said.err;
  EXPECT_THAT(said.err, HasSubstr("scarakins"));
}

TEST_F(LinuxCncStart, AnIniFileThatCannotBeReadIsNoReason) {
  const auto said = run_on("[KINS\n");
  EXPECT_THAT(said.err, Not(HasSubstr("as another user"))) << "its status is there";
}

}  // namespace
}  // namespace steadyrest::test
