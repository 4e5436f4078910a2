// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <span>

#include <steadyrest/chatter/online/detector.hpp>

namespace steadyrest::chatter::online {

/// How sure a stretch of chatter is not forced vibration, 0 … 1.
///
/// Law. Each spectrum gives the probability that its line, off by x from the nearest order with the
/// standard deviation σ, is not at that order: erf(|x|/(σ·√2)), 1 where it can be no order; for
/// flip, which is at an order of the spindle, the line's share of the energy. The confidence is the
/// mean over the n spectra times 1 − 2⁻ⁿ, which keeps short stretches low.
class LineConfidence {
 public:
  /// A spectrum of the stretch: a fresh output that chatters.
  void add(const Detector::Output& heard) noexcept;
  void reset() noexcept { *this = {}; }
  /// 0 without spectra.
  [[nodiscard]] double value() const noexcept;

 private:
  double sure_ = 0.0;
  double spectra_ = 0.0;
};

/// Whether the orders show the spindle's speed better than a control tells it.
[[nodiscard]] bool shows_speed(const Detector::Output& heard) noexcept;

/// The mode nearest to a line; 0: there are no modes.
[[nodiscard]] double nearest_mode_hz(std::span<const double> modes_hz, double line_hz) noexcept;

}  // namespace steadyrest::chatter::online
