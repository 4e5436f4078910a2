// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdio>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <string>

#include <gtest/gtest.h>
#include <stdlib.h>
#include <sys/wait.h>
#include <unistd.h>

#include <steadyrest/kernel/file/output_file.hpp>

/// A folder for outputs, and a child process that writes them.
namespace steadyrest::kernel::file::test {

namespace fs = std::filesystem;

class Output : public testing::Test {
 public:
  Output() {
    std::string pattern = (fs::temp_directory_path() / "steadyrest-file-XXXXXX").string();
    folder_ = mkdtemp(pattern.data());
  }
  ~Output() override { fs::remove_all(folder_); }

 protected:
  [[nodiscard]] std::string at(const std::string& name) const { return (folder_ / name).string(); }
  [[nodiscard]] std::string old(const std::string& name) const {
    std::ofstream(at(name)) << "old\n";
    return at(name);
  }
  static std::string text_of(const std::string& file) {
    std::ifstream in(file, std::ios::binary);
    return {std::istreambuf_iterator<char>(in), std::istreambuf_iterator<char>()};
  }
  [[nodiscard]] std::ptrdiff_t entries() const {
    return std::distance(fs::directory_iterator(folder_), fs::directory_iterator{});
  }

  fs::path folder_;
};

/// Runs `work` in a child, so that limits and signals are its own; gives the status.
template <class Work>
int in_child(Work work) {
  std::fflush(stdout);  // or both would write what is held back
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
