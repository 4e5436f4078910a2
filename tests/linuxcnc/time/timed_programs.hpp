// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <vector>

#include <gtest/gtest.h>

#include <steadyrest/nc/interpret/program.hpp>
#include <steadyrest/nc/plan/time/program_timer.hpp>
#include <steadyrest/passport/file/machine_file.hpp>

/// Programs whose seconds on LinuxCNC are known.
namespace steadyrest::linuxcnc_test {

inline constexpr double kWorst = 0.01;  ///< ratio

struct Case {
  const char* name;
  const char* text;
  double recorded_s;
};

/// Each program stresses one rule of the planner: blending, exact path, tolerances, arcs, sharp and
/// wide corners, rapids between feeds.
inline const std::vector<Case>& own_programs() {
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

inline kernel::machine::Machine mill() {
  auto machine =
      passport::read(STEADYREST_SOURCE_DIR "/examples/machines/linuxcnc-mill.toml").value();
  machine.control.tool_change_s = 0.0;        // the harness loops the tool changer back
  machine.spindle.acceleration_rev_s2 = 1e9;  // and holds at-speed true
  return machine;
}

inline double planned_s(const std::string& text) {
  const auto machine = mill();
  auto timer = nc::plan::ProgramTimer::make(machine).value();
  const auto report = nc::interpret::run_text(text, {}, timer).value();
  EXPECT_TRUE(report.refused.empty());
  return timer.take().value().total_s;
}

}  // namespace steadyrest::linuxcnc_test
