// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdlib>
#include <fstream>
#include <string>
#include <utility>
#include <vector>

#include <gtest/gtest.h>
#include <sys/wait.h>
#include <tests/linuxcnc/measure.hpp>

#include <steadyrest/kernel/file/testing/own_folder.hpp>

/// The built program on the mill of the examples, which a headless LinuxCNC plays.
namespace steadyrest::linuxcnc_test {

inline int status_of(const std::string& command) {
  const int status = std::system(command.c_str());
  return WIFEXITED(status) ? WEXITSTATUS(status) : -1;
}

/// The mill's machine file with other text in places.
inline void write_mill(const std::string& file,
                       const std::vector<std::pair<std::string, std::string>>& changes = {
                           {"port = \"sim\"", "port = \"linuxcnc\""}}) {
  std::string text = kernel::file::testing::text_of_file(STEADYREST_SOURCE_DIR
                                                         "/examples/machines/linuxcnc-mill.toml");
  for (const auto& [old, now] : changes) {
    const std::size_t at = text.find(old);
    ASSERT_NE(at, std::string::npos) << old;
    text.replace(at, old.size(), now);
  }
  std::ofstream(file) << text;
}

struct Drive {
  std::string script;   ///< of this folder
  std::string program;  ///< of the test's folder
  std::string hal = "lag.hal layer.hal";
  std::string arguments{};
};

/// measure.sh's exit status. The machine file is the folder's machine.toml; the log, and what the
/// script leaves beside it, come into the folder.
inline int run_on_linuxcnc(const kernel::file::testing::OwnFolder& folder, const Drive& drive) {
  return status_of("DRIVE=" + drive.script + " DRIVE_ARGS='" + drive.arguments +
                   "' PROBE='" STEADYREST_PROGRAM "' MACHINE='" + folder.at("machine.toml") +
                   "' HAL='" + drive.hal +
                   "' bash " STEADYREST_SOURCE_DIR "/tests/linuxcnc/measure.sh '" +
                   folder.at(drive.program) + "' '" + folder.at("log") + "'");
}

}  // namespace steadyrest::linuxcnc_test
