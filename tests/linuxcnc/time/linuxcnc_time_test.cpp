// SPDX-License-Identifier: Apache-2.0
// Seconds of programs against LinuxCNC 2.9.0~pre1 (Debian 12). The recorded figures are servo
// periods of 1 ms from the first to the last one out of position, counted by its own sampler with
// measure.sh on 21 November 2026 with the limits of examples/machines/linuxcnc-mill.toml. 1 % is
// the tolerance, because the figures are read to a whole servo period and the shortest program
// takes a second.
#include <filesystem>
#include <fstream>
#include <sstream>
#include <string>
#include <utility>
#include <vector>

#include <gtest/gtest.h>
#include <tests/linuxcnc/time/timed_programs.hpp>

#include <steadyrest/kernel/file/testing/recorded.hpp>

namespace steadyrest {
namespace {

using linuxcnc_test::Case;
using linuxcnc_test::kWorst;
using linuxcnc_test::own_programs;
using linuxcnc_test::planned_s;

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

}  // namespace
}  // namespace steadyrest
