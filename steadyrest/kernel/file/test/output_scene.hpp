// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdio>
#include <filesystem>
#include <iterator>
#include <string>

#include <gtest/gtest.h>
#include <sys/wait.h>
#include <unistd.h>

#include <steadyrest/kernel/file/output_file.hpp>
#include <steadyrest/kernel/file/testing/own_folder.hpp>

/// A folder for outputs, and a child process that writes them.
namespace steadyrest::kernel::file::test {

namespace fs = std::filesystem;

class Output : public ::testing::Test {
 protected:
  [[nodiscard]] std::string at(const std::string& name) const { return folder_.at(name); }
  [[nodiscard]] std::string old(const std::string& name) const {
    return folder_.file(name, "old\n");
  }
  static std::string text_of(const std::string& file) { return testing::text_of_file(file); }
  [[nodiscard]] std::ptrdiff_t entries() const {
    return std::distance(fs::directory_iterator(folder_.path()), fs::directory_iterator{});
  }

  testing::OwnFolder folder_;
};

/// Runs `work` in a child process with limits and signals of its own; returns its status.
template <class Work>
int in_child(Work work) {
  std::fflush(stdout);  // otherwise both would write what is buffered
  const pid_t child = fork();
  if (child == 0) {
    remove_temporaries_on_signals();
    work();
    _exit(0);
  }
  int status = -1;
  waitpid(child, &status, 0);
  return status;
}

}  // namespace steadyrest::kernel::file::test
