// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <vector>

#include <sys/types.h>

namespace steadyrest::test {

/// The built `steadyrest`, running in a folder of the test, which may kill it. Its output for
/// people is discarded.
class Process {
 public:
  enum class Stdout { nowhere, closed_pipe };
  struct Limits {
    long largest_file = -1;  ///< most bytes in a file, as on a full disk; −1: no limit
    Stdout out = Stdout::nowhere;
  };

  Process(const std::vector<std::string>& arguments, const std::string& folder, Limits limits);
  Process(const std::vector<std::string>& arguments, const std::string& folder)
      : Process(arguments, folder, Limits{}) {}
  Process(const Process&) = delete;
  Process& operator=(const Process&) = delete;
  ~Process();

  /// Readable once it has ended.
  [[nodiscard]] int ended() const noexcept { return pidfd_; }
  void send(int signal) const noexcept;
  /// Exit code, or −signal.
  int wait();
  /// Its stderr output; after wait().
  [[nodiscard]] const std::string& err() const noexcept { return err_; }

 private:
  pid_t child_ = -1;
  int pidfd_ = -1;
  int err_read_ = -1;
  int code_ = 0;
  std::string err_;
};

}  // namespace steadyrest::test
