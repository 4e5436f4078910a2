// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <optional>

#include <steadyrest/sim/axis/encoder.hpp>

namespace steadyrest::sim {

/// A stretch of motion: the cubic through position and velocity at both of its ends.
struct Stretch {
  double duration_s = 0.0;  ///< h, > 0
  double start_mm = 0.0;
  double start_mm_s = 0.0;
  double end_mm = 0.0;
  double end_mm_s = 0.0;
};

/// The passage of one line of the encoder.
struct Passage {
  double before_end_s = 0.0;  ///< how long before the stretch's end, 0 … h
  std::int8_t direction = 1;  ///< +1: the count rose, −1: it fell
};

/// The last line passed in the stretch, with the counter at `count_at_end` at its end; empty when
/// the count did not change.
///
/// Law: the reading x + A·sin(2π·x/p) of x(t) crosses a border of its counts, (n − ½)·count. A
/// reversal divides the stretch, so a line passed both ways is seen although the count is the same
/// again. The instant is exact to the larger of 1e-8 counts and 1e-15 s. The cubic replaces the
/// axis's own law, matching position and velocity at both ends (it misses a lag of rate k by
/// (k·h)⁴/384 of its amplitude). One function of + − × ÷ √ only: the same bits everywhere.
[[nodiscard]] std::optional<Passage> last_passage(const Encoder& encoder, const Stretch& stretch,
                                                  std::int64_t count_at_end) noexcept;

}  // namespace steadyrest::sim
