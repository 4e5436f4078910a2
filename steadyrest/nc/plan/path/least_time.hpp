// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <optional>

#include <steadyrest/kernel/outcome/result.hpp>
#include <steadyrest/nc/plan/path/piece.hpp>

namespace steadyrest::nc::plan {

/// Adds up the least time of a program: Σ length/feed and dwells, at 100 % and without ramps. A
/// program of months is refused before it is run through period by period. Rapids count as 0.
class LeastTime {
 public:
  /// The refusal when the program exceeds kLongestProgram_s with this piece, alone or with all
  /// before.
  [[nodiscard]] std::optional<kernel::outcome::Refusal> add(const Piece& piece,
                                                            const interpret::Move& move);
  [[nodiscard]] std::optional<kernel::outcome::Refusal> add_dwell(const interpret::Move& dwell);

 private:
  [[nodiscard]] std::optional<kernel::outcome::Refusal> add_time(double seconds,
                                                                 std::uint32_t line);

  double total_s_ = 0.0;
};

}  // namespace steadyrest::nc::plan
