// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <optional>
#include <vector>

#include <steadyrest/contour/offline/identify/servo_orders.hpp>

namespace steadyrest::contour::offline {

/// Gain, and gain with feed-forward, each with a delay of no cycle and of one.
struct SimplestLaws {
  ServoFitted fitted[2][2];  ///< by cycles of delay, by feed-forward
  /// What it leaves is within the counts and what the command does between samples: the record
  /// tells no more, whatever the likelihood says.
  bool enough[2][2] = {};
};

[[nodiscard]] SimplestLaws simplest_of(const ServoProblem& whole);

/// The likeliest law that is enough for each axis, the delay common to all; empty where there is
/// none.
[[nodiscard]] std::optional<std::vector<ServoNumbers>> enough_for_all(
    const std::vector<const ServoProblem*>& problems, const std::vector<SimplestLaws>& axes);

/// The likeliest of the simplest laws where the record does not speak against it; in place of a
/// larger one that it does not determine, whose interval of τ and delay it keeps.
[[nodiscard]] std::optional<ServoNumbers> in_place_of(const ServoProblem& whole,
                                                      const SimplestLaws& simplest,
                                                      const ServoNumbers& larger);

}  // namespace steadyrest::contour::offline
