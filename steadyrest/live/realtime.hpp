// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <vector>

namespace steadyrest::live {

/// What the operating system has granted the thread that asked.
struct RealTime {
  bool memory_locked = false;
  bool priority = false;             ///< SCHED_FIFO
  std::vector<std::string> refused;  ///< each with what to do about it
};

/// Locks the memory of the process and gives the calling thread real-time priority; goes on without
/// where it is not allowed.
[[nodiscard]] RealTime ask_for_real_time();

}  // namespace steadyrest::live
