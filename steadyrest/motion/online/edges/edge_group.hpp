// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>

/// Groups edges into one measurement for the filter.
///
/// At 500 edges per cycle the filter gains nothing from each single edge. Edges of one direction
/// are averaged in multiples of four, so that every phase counts equally and their errors cancel:
/// mean position at the mean time. The parabola's share, a·var(t)/2, is passed on.
namespace steadyrest::motion::online {

struct Observation {
  double t_s = 0.0;
  double x = 0.0;              ///< counts
  double time_variance = 0.0;  ///< s²: x lies a·time_variance/2 above the position at t_s
  std::uint32_t edges = 1;
  std::int8_t direction = 1;
  double variance = -1.0;  ///< counts², of one edge where known to exceed the learnt one
};

class EdgeGroup {
 public:
  /// Up to this many edges in the last cycle are taken singly.
  static constexpr std::uint32_t kSingle = 16;
  /// Approximate number of groups per cycle.
  static constexpr std::uint32_t kGroups = 8;

  /// True when `out` is a complete observation, to be used before the next edge is added.
  bool add(double t_s, double x, std::int8_t direction, Observation& out) noexcept {
    ++in_cycle_;
    if (target_ <= 1) {
      out = {t_s, x, 0.0, 1, direction};
      return true;
    }
    if (n_ == 0) {
      start_s_ = t_s;
      start_x_ = x;
      direction_ = direction;
    }
    const double d = t_s - start_s_;
    ++n_;
    sum_t_ += d;
    sum_tt_ += d * d;
    sum_x_ += x - start_x_;
    return n_ >= target_ && take(out);
  }
  /// The direction changes or the cycle ends: returns the group so far.
  bool take(Observation& out) noexcept {
    if (n_ == 0) {
      return false;
    }
    const double k = 1.0 / static_cast<double>(n_);
    const double mean = sum_t_ * k;
    out = {start_s_ + mean, start_x_ + sum_x_ * k, sum_tt_ * k - mean * mean, n_, direction_};
    n_ = 0;
    sum_t_ = sum_tt_ = sum_x_ = 0.0;
    return true;
  }
  [[nodiscard]] bool turns(std::int8_t direction) const noexcept {
    return n_ > 0 && direction != direction_;
  }
  void end_of_cycle() noexcept {
    target_ = in_cycle_ > kSingle ? (in_cycle_ / kGroups + 3) / 4 * 4 : 1;
    in_cycle_ = 0;
  }

 private:
  std::uint32_t in_cycle_ = 0;
  std::uint32_t target_ = 1;
  std::uint32_t n_ = 0;
  std::int8_t direction_ = 1;
  double start_s_ = 0.0;
  double start_x_ = 0.0;
  double sum_t_ = 0.0;
  double sum_tt_ = 0.0;
  double sum_x_ = 0.0;
};

}  // namespace steadyrest::motion::online
