// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <limits>

namespace steadyrest::chatter::online {

/// A sensor that gives nothing, and one that gives no more than its largest value.
///
/// Law. A gap is a value that is not a number, or that repeats: with p the share of samples that
/// are as the one before, learnt as they come (coarse counts repeat often), n repeats in a row have
/// the probability pⁿ; below kNoChance they are a gap, from the third equal sample on in a fine
/// signal. Repeats of the largest value so far are clipped; more than kClipped of all samples over
/// about a second, and the sensor counts as clipping.
class SensorFaults {
 public:
  explicit SensorFaults(double sample_rate_hz) : rate_hz_(sample_rate_hz) {}

  /// True where the value is to be left out.
  bool update(double value) noexcept;
  [[nodiscard]] bool clips() const noexcept { return clipped_share_ > kClipped; }
  void reset() noexcept { *this = SensorFaults(rate_hz_); }

 private:
  static constexpr double kClipped = 0.002;
  static constexpr double kLeastRepeats = 1e-3;

  double rate_hz_;
  double last_ = std::numeric_limits<double>::quiet_NaN();
  double repeat_share_ = 0.03;
  double rail_ = 0.0;  ///< the largest value
  double clipped_share_ = 0.0;
  double seen_ = 0.0;
  std::size_t repeats_ = 0;
};

}  // namespace steadyrest::chatter::online
