// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <functional>
#include <string>

namespace steadyrest::bench::hostile {

/// What a hunt through the running loop has seen.
struct DaemonTally {
  std::uint64_t cycles = 0;
  std::uint64_t written = 0;
  std::uint64_t masked = 0;     ///< of these, with a mask on
  std::uint64_t moved = 0;      ///< words or offsets that changed under a mask
  std::uint64_t failed = 0;     ///< reads and writes that did not go through
  std::uint64_t asked = 0;      ///< questions over the protocol
  std::uint64_t allocated = 0;  ///< by the loop, its port and its judge left out
  std::uint64_t broken = 0;     ///< scenes in which a law was
  std::string first;            ///< the first broken law, with machine, seed and cycle

  void add(const DaemonTally& other);
};

struct DaemonHunt {
  std::string machine;  ///< of examples/machines
  std::uint64_t seed = 1;
  std::uint64_t cycles = 100'000;  ///< at least
  std::uint64_t scene = 4000;      ///< cycles between two starts of the layer
  // Designated initialisers may leave it out.
  // NOLINTNEXTLINE(readability-redundant-member-init)
  std::function<std::size_t()> allocations = {};  ///< of this thread so far; empty: not counted
};

/// The whole loop with all rooms on (tests/rig) on a WildPort, under random modes and questions.
///
/// Laws, judged at the port. Every written command: numbers finite; reasons with a name; heartbeat
/// rises; feed and spindle by OverrideWatch (word in the table, panel, mixtures, slew) and not
/// above the envelope's maximum; the ratio that is stated is the word's; offsets by OffsetWatch
/// (clamp, slew). Nothing is written in observe and advise but what hands back. The loop ends only
/// when it is told to, after good input everything is handed back, and every answer to a client is
/// JSON.
[[nodiscard]] DaemonTally hunt(const DaemonHunt& hunt);

}  // namespace steadyrest::bench::hostile
