// SPDX-License-Identifier: Apache-2.0
#include <cerrno>
#include <cstring>
#include <thread>

#include <fmt/core.h>
#include <sched.h>
#include <sys/mman.h>

#include <steadyrest/live/realtime.hpp>

namespace steadyrest::live {
namespace {

/// Below the kernel's own threads, above all that is not real-time.
constexpr int kPriority = 40;

}  // namespace

RealTime ask_for_real_time() {
  RealTime out;
  out.memory_locked = mlockall(MCL_CURRENT | MCL_FUTURE) == 0;
  if (!out.memory_locked) {
    out.refused.push_back({fmt::format("memory is not locked ({}): a page fault may delay a cycle",
                                       std::strerror(errno)),
                           "raise the limit memlock"});
  }
  const sched_param wanted{.sched_priority = kPriority};
  out.priority = sched_setscheduler(0, SCHED_FIFO, &wanted) == 0;
  if (!out.priority) {
    out.refused.push_back(
        {fmt::format("no real-time priority ({}): other programs may delay a cycle",
                     std::strerror(errno)),
         fmt::format("raise the limit rtprio to {}", kPriority)});
  }
  return out;
}

// A thread's priority ends with it.
RealTime real_time_allowed() {
  RealTime out;
  std::thread([&out] { out = ask_for_real_time(); }).join();
  if (out.memory_locked) {
    munlockall();
  }
  return out;
}

}  // namespace steadyrest::live
