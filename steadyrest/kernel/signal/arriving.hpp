// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <steadyrest/kernel/signal/path.hpp>

namespace steadyrest::kernel::signal {

/// What a tool that lags behind its command is doing.
///
/// Law. While the command moves, what it does. Once it waits (dwell, tool change, end of the
/// program) the tool is still on its way, for 8/k of the softest axis: e⁻⁸ of the lag, 1 µm of
/// 3 mm. So long it does what the command did before.
class Arriving {
 public:
  /// `gain_1_s`: the lowest of the axes' servo gains, > 0.
  explicit Arriving(double gain_1_s) noexcept : arrives_s_(kArrives / gain_1_s) {}

  /// Time never falls.
  Motion update(Motion commanded, double time_s) noexcept {
    const bool waits = commanded == Motion::idle || commanded == Motion::dwell ||
                       commanded == Motion::tool_change || commanded == Motion::spindle_wait;
    if (!waits) {
      moved_ = commanded;
      since_s_ = time_s;
    }
    cuts_on_ = waits && in_cut(moved_) && time_s - since_s_ <= arrives_s_;
    return cuts_on_ ? moved_ : commanded;
  }

  /// The command waits, the tool still cuts.
  [[nodiscard]] bool cuts_on() const noexcept { return cuts_on_; }

 private:
  static constexpr double kArrives = 8.0;

  double arrives_s_;
  double since_s_ = 0.0;
  Motion moved_ = Motion::idle;
  bool cuts_on_ = false;
};

}  // namespace steadyrest::kernel::signal
