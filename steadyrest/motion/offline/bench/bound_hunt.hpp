// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <string>

/// Searches for a tick at which the guaranteed bound does not hold: random motions, encoders,
/// clocks and lags.
namespace steadyrest::motion::offline {

struct Hunt {
  std::uint64_t ticks = 0;
  std::uint64_t records = 0;
  std::uint64_t velocity_outside = 0;  ///< ticks with |error| > bound
  std::uint64_t acceleration_outside = 0;
  std::uint64_t position_outside = 0;
  std::uint64_t contradictions = 0;  ///< no motion within the limits explains the record
  std::string first;                 ///< the first finding, with enough to repeat it
};

/// Records `seed`, `seed` + 1 … until `ticks` are done. Deterministic.
[[nodiscard]] Hunt hunt_bounds(std::uint64_t seed, std::uint64_t ticks);

}  // namespace steadyrest::motion::offline
