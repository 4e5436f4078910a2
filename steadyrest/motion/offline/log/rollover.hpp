// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>

namespace steadyrest::motion::offline {

/// Unwraps a counter of 16, 24 or 32 bits, signed or not, row by row.
///
/// A step of the count is a rollover by ±2ᴮ if both its ends lie in the counter's range and the
/// step less 2ᴮ continues the one before: |Δ − Δ₋·t/t₋| ≤ ½·max(|Δ|, |Δ₋|) + 64 counts, |Δ| < 2ᴮ/8,
/// with t, t₋ the times of the two. The first rollover settles B. Anything else (a reset to zero,
/// lost bits of a cable) stays a jump. An axis that passes 2ᴮ/8 counts from row to row cannot be
/// unwrapped.
class Rollover {
 public:
  /// The count without rollovers.
  [[nodiscard]] std::int64_t unwrapped(double t_s, std::int64_t count);

  [[nodiscard]] std::size_t times() const noexcept { return times_; }
  /// Of the counter; 0 before the first rollover.
  [[nodiscard]] int bits() const noexcept { return bits_; }

 private:
  [[nodiscard]] std::optional<std::int64_t> turned(double t_s, std::int64_t count, int bits) const;

  bool started_ = false;
  double t_s_ = 0.0;
  std::int64_t count_ = 0;   ///< as written
  std::int64_t offset_ = 0;  ///< whole turns
  double step_ = 0.0;        ///< unwrapped
  double step_s_ = 0.0;
  int bits_ = 0;
  std::size_t times_ = 0;
};

}  // namespace steadyrest::motion::offline
