// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <bit>
#include <cstddef>
#include <limits>

namespace steadyrest::contour::online {

/// Finds the step of a table with the lowest value, one look at a time, so that it can be
/// interrupted and resumed.
///
/// Up to `exhaustive_steps` it looks at all; in larger tables in kStrides strides or fewer, then
/// ever closer around the best: where the values form one valley it finds the best. Values within
/// `tie` of each other are equal; among equals the highest step wins.
class ObjectiveSearch {
 public:
  /// n/s + 2·log₂ s looks: for 64 steps 14 at s = 8, 20 at 4, 12 at 16, which sees only a quarter
  /// of the range's valleys; for 201 steps 17 at s = 32.
  static constexpr std::size_t kStrides = 8;

  void begin(std::size_t steps, std::size_t exhaustive_steps) noexcept {
    *this = {};
    steps_ = steps;
    stride_ = steps <= exhaustive_steps ? 1 : std::bit_ceil((steps + kStrides - 1) / kStrides);
  }
  [[nodiscard]] bool done() const noexcept { return stride_ == 0; }
  /// The next step to look at, unless done.
  [[nodiscard]] std::size_t next() const noexcept { return next_; }
  /// Reports that step's value.
  void tell(double value, double tie) noexcept {
    if (value < least_ - tie || (value <= least_ + tie && next_ >= best_)) {
      best_ = next_;
      least_ = value < least_ ? value : least_;
    }
    advance();
  }
  [[nodiscard]] std::size_t best() const noexcept { return best_; }

 private:
  void advance() noexcept {
    if (sweeps_ && next_ + stride_ < steps_) {
      next_ += stride_;
      return;
    }
    if (!sweeps_ && next_ < around_ && around_ + stride_ < steps_) {
      next_ = around_ + stride_;
      return;
    }
    sweeps_ = false;
    around_ = best_;
    for (stride_ /= 2; stride_ > 0; stride_ /= 2) {
      if (around_ >= stride_ || around_ + stride_ < steps_) {
        next_ = around_ >= stride_ ? around_ - stride_ : around_ + stride_;
        return;
      }
    }
  }

  std::size_t steps_ = 0;
  std::size_t stride_ = 0;
  std::size_t next_ = 0;
  std::size_t around_ = 0;
  std::size_t best_ = 0;
  bool sweeps_ = true;
  double least_ = std::numeric_limits<double>::infinity();
};

}  // namespace steadyrest::contour::online
