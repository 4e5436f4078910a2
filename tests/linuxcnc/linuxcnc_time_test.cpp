// SPDX-License-Identifier: Apache-2.0
// Seconds of programs against LinuxCNC 2.9.0~pre1 (Debian 12). The recorded figures are servo
// periods of 1 ms from the first to the last one out of position, counted by its own sampler with
// measure.sh on 21 November 2026 with the limits of examples/machines/linuxcnc-mill.toml. 1 % is
// the tolerance, because the figures are read to a whole servo period and the shortest program
// takes a second.
#include <cmath>
#include <cstdio>
#include <filesystem>
#include <fstream>
#include <sstream>
#include <string>
#include <vector>

#include <gtest/gtest.h>
#include <sys/wait.h>
#include <unistd.h>

#include <steadyrest/kernel/file/testing/recorded.hpp>
#include <steadyrest/nc/interpret/program.hpp>
#include <steadyrest/nc/plan/time/program_timer.hpp>
#include <steadyrest/passport/file/machine_file.hpp>

namespace steadyrest {
namespace {

constexpr double kWorst = 0.01;  ///< ratio

struct Case {
  const char* name;
  const char* text;
  double recorded_s;
};

/// Each program stresses one rule of the planner: blending, exact path, tolerances, arcs, sharp and
/// wide corners, rapids between feeds.
const std::vector<Case>& own_programs() {
  static const std::vector<Case> cases = {
      {"square_G64", "G21 G90 G64\nF6000\nG1 X20\nY20\nX0\nY0\nX20\nY20\nM2\n", 1.139},
      {"square_G64_P0.1", "G21 G90 G64 P0.1\nF6000\nG1 X20\nY20\nX0\nY0\nX20\nY20\nM2\n", 1.519},
      {"square_G61", "G21 G90 G61\nF6000\nG1 X20\nY20\nX0\nY0\nX20\nY20\nM2\n", 1.536},
      {"arcs_and_lines",
       "G21 G90 G64 P0.1\nF4000\nG1 X10\nG2 X20 Y0 I5 J0\nG1 X30\nG3 X40 Y10 I0 J10\nG1 X60\n"
       "G2 X80 Y10 I10 J10\nG1 X100\nM2\n",
       2.630},
      {"turn_45", "G21 G90 G64\nF3000\nG1 X20\nX40 Y20\nX60\nM2\n", 1.399},
      {"turn_120", "G21 G90 G64\nF3000\nG1 X20\nX10 Y17.3205\nX30\nM2\n", 1.159},
      {"rapids_helix",
       "G21 G90 G64 P0.05\nF3000\nG1 X10 Z-2\nG1 Z-5\nG2 X30 Y0 I10 J0\nG3 X10 I-10 J0 Z-10\n"
       "G1 X0 Y0\nG0 Z5\nG0 X100 Y100\nG0 Z0\nG1 Z-5\nG1 X120\nM2\n",
       3.470},
  };
  return cases;
}

kernel::machine::Machine mill() {
  auto machine =
      passport::read(STEADYREST_SOURCE_DIR "/examples/machines/linuxcnc-mill.toml").value();
  machine.control.tool_change_s = 0.0;        // the harness loops the tool changer back
  machine.spindle.acceleration_rev_s2 = 1e9;  // and holds at-speed true
  return machine;
}

double planned_s(const std::string& text) {
  const auto machine = mill();
  auto timer = nc::plan::ProgramTimer::make(machine).value();
  const auto report = nc::interpret::run_text(text, {}, timer).value();
  EXPECT_TRUE(report.refused.empty());
  return timer.take().value().total_s;
}

TEST(ProgramTimeAgainstLinuxCnc, OwnProgramsAgreeWithTheRecordedFigures) {
  for (const Case& c : own_programs()) {
    EXPECT_NEAR(planned_s(c.text), c.recorded_s, kWorst * c.recorded_s) << c.name;
  }
}

std::string real_text(const std::string& path) {
  std::ifstream in(path);
  std::stringstream text;
  text << in.rdbuf() << "\nM2\n";  // as measure.sh does
  return text.str();
}

// Other people's programs, with inches, polar coordinates and words full of parameters.
TEST(ProgramTimeAgainstLinuxCnc, RealProgramsAgreeWithTheRecordedFigures) {
  const std::string data = kernel::file::testing::shared_data();
  const std::vector<std::pair<std::string, double>> recorded = {
      {data + "/nc/cncjs/circle.gcode", 9.795},
      {data + "/nc/cncjs/arc-ijk.gcode", 15.429},
      {data + "/nc/cncjs/arc-xz-plane.gcode", 34.279},
      {data + "/nc/cncjs/circle-inch.gcode", 78.384},
      {data + "/nc/cncjs/g2-arc.gcode", 52.086},
      {"/usr/share/linuxcnc/ncfiles/3dtest.ngc", 48.691},
      {"/usr/share/linuxcnc/ncfiles/arcspiral.ngc", 253.718},
      {"/usr/share/linuxcnc/ncfiles/3D_Chips.ngc", 51.771},  // parameters in every word
      {"/usr/share/linuxcnc/ncfiles/polar.ngc", 25.355},
      {"/usr/share/linuxcnc/ncfiles/hole-circle.ngc", 21.078},
      {"/usr/share/doc/linuxcnc/examples/sample-configs/sim/craftsman/screens/craftsmancnc.ngc",
       38.119},
  };
  if (!std::filesystem::exists(recorded.front().first)) {
    GTEST_SKIP() << "the shared programs are not here: " << recorded.front().first;
  }
  for (const auto& [path, seconds] : recorded) {
    if (!std::filesystem::exists(path)) {
      continue;  // the package linuxcnc-uspace is not installed
    }
    EXPECT_NEAR(planned_s(real_text(path)), seconds, kWorst * seconds) << path;
  }
}

// The figures again, measured live where LinuxCNC is installed: they may drift with its version.
TEST(ProgramTimeAgainstLinuxCnc, LinuxCncStillTakesAsLong) {
  const auto folder =
      std::filesystem::path("/var/tmp") / ("steadyrest-" + std::to_string(getpid()));
  std::filesystem::create_directories(folder);
  for (const Case& c : own_programs()) {
    const auto program = folder / (std::string(c.name) + ".ngc");
    std::ofstream(program) << c.text;
    const std::string command =
        std::string(STEADYREST_SOURCE_DIR "/tests/linuxcnc/measure.sh ") + program.string();
    FILE* pipe = popen(command.c_str(), "r");
    ASSERT_NE(pipe, nullptr);
    double periods = 0.0;
    const int read = fscanf(pipe, "%lf", &periods);
    const int status = pclose(pipe);
    if (WIFEXITED(status) && WEXITSTATUS(status) == 77) {
      std::filesystem::remove_all(folder);
      GTEST_SKIP() << "LinuxCNC is not installed or namespaces are not permitted";
    }
    ASSERT_EQ(read, 1) << c.name;
    EXPECT_NEAR(planned_s(c.text), 0.001 * periods, kWorst * 0.001 * periods) << c.name;
  }
  std::filesystem::remove_all(folder);
}

}  // namespace
}  // namespace steadyrest
