// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdlib>
#include <string>

#include "process.hpp"
#include "program.hpp"
#include "scratch.hpp"
#include <gtest/gtest.h>
#include <unistd.h>

namespace steadyrest::test {

/// A layer that runs on the simulated machine in the background, with the usual socket in a
/// temporary folder.
class LiveLayer {
 public:
  explicit LiveLayer(const std::string& mode = "observe")
      : socket_folder_((::setenv("XDG_RUNTIME_DIR", scratch_.at("").c_str(), 1), scratch_.at(""))),
        process_({"run", "--machine", project_file("examples/machines/vmc-840d.toml"), "--program",
                  project_file("examples/programs/rib-pocket.mpf"), "--mode", mode},
                 scratch_.at("")) {
    constexpr int kTries = 6000;
    constexpr unsigned kNap_us = 10'000;
    for (int i = 0;
         i < kTries && ::access((socket_folder_ + "/steadyrest.sock").c_str(), F_OK) != 0; ++i) {
      ::usleep(kNap_us);
    }
    EXPECT_EQ(::access((socket_folder_ + "/steadyrest.sock").c_str(), F_OK), 0);
  }
  LiveLayer(const LiveLayer&) = delete;
  LiveLayer& operator=(const LiveLayer&) = delete;
  ~LiveLayer() { ::unsetenv("XDG_RUNTIME_DIR"); }

  [[nodiscard]] Process& process() noexcept { return process_; }

 private:
  Scratch scratch_;
  std::string socket_folder_;
  Process process_;
};

}  // namespace steadyrest::test
