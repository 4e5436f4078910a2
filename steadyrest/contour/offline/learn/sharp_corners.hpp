// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <vector>

#include <steadyrest/kernel/signal/path.hpp>

namespace steadyrest::contour::offline {

/// Where a cut begins, ends or has a corner: what is learnt on one side says nothing of the other.
class SharpCorners {
 public:
  explicit SharpCorners(std::vector<double> at_mm) : at_mm_(std::move(at_mm)) {}

  [[nodiscard]] bool between(double low_mm, double high_mm) const noexcept {
    const auto next = std::ranges::upper_bound(at_mm_, low_mm);
    return next != at_mm_.end() && *next <= high_mm;
  }
  /// The nearest at or before a place, or at or after it.
  [[nodiscard]] double before(double at_mm) const noexcept {
    const auto next = std::ranges::upper_bound(at_mm_, at_mm);
    return next == at_mm_.begin() ? at_mm : *(next - 1);
  }
  [[nodiscard]] double after(double at_mm) const noexcept {
    const auto next = std::ranges::lower_bound(at_mm_, at_mm);
    return next == at_mm_.end() ? at_mm : *next;
  }

 private:
  std::vector<double> at_mm_;  ///< ascending
};

/// Joints at which the direction changes by more than 0.3 (|t′ − t|), and ends of cuts.
[[nodiscard]] SharpCorners sharp_corners(kernel::signal::PathView path);

}  // namespace steadyrest::contour::offline
