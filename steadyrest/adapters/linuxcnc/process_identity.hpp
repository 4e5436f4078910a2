// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <optional>

namespace steadyrest::adapters::linuxcnc {

/// A process, told apart from a later one with the same number by the time it started.
struct ProcessIdentity {
  std::uint32_t number = 0;
  std::uint32_t start = 0;  ///< in the kernel's ticks since boot; 0: not known
};

/// When a process started; none if there is no such process, or it has ended and its parent has
/// not asked yet (a zombie). /proc/N/stat, proc(5).
[[nodiscard]] std::optional<std::uint32_t> start_of(std::uint32_t number);

[[nodiscard]] ProcessIdentity this_process();

/// It has not ended.
[[nodiscard]] bool runs(const ProcessIdentity& process);

}  // namespace steadyrest::adapters::linuxcnc
