// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <functional>
#include <optional>
#include <string>
#include <vector>

#include <steadyrest/kernel/machine/machine.hpp>
#include <steadyrest/kernel/outcome/result.hpp>
#include <steadyrest/kernel/signal/command.hpp>

namespace steadyrest::trial::replay {

/// A cycle in which the layer decides otherwise than it did.
struct Difference {
  std::uint64_t cycle = 0;  ///< of the control
  double time_s = 0.0;
  std::uint32_t line = 0;           ///< of the program
  std::vector<std::string> fields;  ///< `command.feed_ratio`, …
  kernel::signal::Command recorded;
  kernel::signal::Command decided;
};

struct Replayed {
  std::uint64_t cycles = 0;     ///< compared
  std::uint64_t different = 0;  ///< of these
  std::optional<Difference> first_difference;
  /// Cycle after which samples are missing: the comparison ends there, since the layer would go on
  /// from another state.
  std::optional<std::uint64_t> gap_after;
  bool paths_complete = true;  ///< else a difference may come from a path that was cut off
  std::uint64_t reloads = 0;   ///< machine files that took over during the run
  std::uint64_t wishes = 0;    ///< of people, that were granted again
};

enum class Reloads : std::uint8_t {
  follow,  ///< each recorded machine file takes over in the cycle in which it did
  ignore   ///< `machine` decides to the end
};

/// Runs a fresh layer through the recorded frames and compares each command with the recorded one,
/// bit for bit. The recorded machine answers to the recorded commands: after the first difference
/// the rest is only a guess.
///
/// Refuses a record that cannot be read, a machine that the supervisor refuses, and what `goes_on`,
/// asked every now and then, has ended.
[[nodiscard]] kernel::outcome::Result<Replayed> replay(
    const std::string& file, const kernel::machine::Machine& machine,
    const std::function<bool(double share)>& goes_on = [](double) { return true; },
    Reloads reloads = Reloads::follow);

}  // namespace steadyrest::trial::replay
