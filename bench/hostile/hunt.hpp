// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <string>

#include <steadyrest/kernel/machine/machine.hpp>

namespace steadyrest::bench::hostile {

/// The result of a hunt.
struct Tally {
  std::uint64_t cycles = 0;
  std::uint64_t written = 0;      ///< commands that reached the machine
  std::uint64_t masked = 0;       ///< of these, with a mask on
  std::uint64_t moved = 0;        ///< words that changed under a mask
  std::uint64_t held = 0;         ///< in a thread with a mask on
  std::uint64_t interrupted = 0;  ///< restarts and lost links
  std::uint64_t broken = 0;
  std::string first;  ///< the first broken rule, with seed and cycle

  void add(const Tally& other);
};

/// Runs the supervisor on a hostile control for at least this many cycles; scenes from `seed` on.
/// Every scene is another variant of the machine: port, slew, operator's rights, mode.
[[nodiscard]] Tally hunt(const kernel::machine::Machine& machine, std::uint64_t seed,
                         std::uint64_t cycles);

}  // namespace steadyrest::bench::hostile
