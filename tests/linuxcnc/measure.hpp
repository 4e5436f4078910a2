// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdlib>
#include <fstream>
#include <string>

#include <sys/wait.h>

namespace steadyrest::linuxcnc_test {

/// measure.sh: no LinuxCNC, or no namespaces.
inline constexpr int kCannotRun = 77;

struct Ran {
  int status = kCannotRun;  ///< of measure.sh
  double seconds = 0.0;     ///< from the first to the last period out of position
};

/// Runs the program on LinuxCNC. Its task feeds the planner from user space, and a computer busy
/// for long enough lets the queue run dry: the planner then stops on the way, which its own log
/// shows as more periods than it needs. Such a run says nothing of the program and is repeated.
/// `seconds`: of the plan.
inline Ran run_planned(const std::string& program, const std::string& log, double seconds) {
  constexpr int kTries = 8;
  constexpr double kDry = 1.004;
  constexpr double kPeriod_s = 0.001;
  Ran ran;
  for (int i = 0; i < kTries; ++i) {
    const std::string periods = log + ".periods";
    const std::string command = "bash " STEADYREST_SOURCE_DIR "/tests/linuxcnc/measure.sh " +
                                program + " " + log + " >" + periods;
    ran.status = WEXITSTATUS(std::system(command.c_str()));
    double count = 0.0;
    std::ifstream(periods) >> count;
    ran.seconds = count * kPeriod_s;
    if (ran.status == kCannotRun || (ran.status == 0 && ran.seconds <= kDry * seconds)) {
      break;
    }
  }
  return ran;
}

}  // namespace steadyrest::linuxcnc_test
