// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <vector>

namespace steadyrest::live {

/// What the operating system has granted the thread that asked.
struct RealTime {
  struct Refused {
    std::string what;
    std::string to_do;
  };
  bool memory_locked = false;
  bool priority = false;  ///< SCHED_FIFO
  std::vector<Refused> refused;
};

/// Locks the memory of the process and gives the calling thread real-time priority; goes on without
/// where it is not allowed.
[[nodiscard]] RealTime ask_for_real_time();
/// What it would be granted; keeps nothing of it.
[[nodiscard]] RealTime real_time_allowed();

}  // namespace steadyrest::live
