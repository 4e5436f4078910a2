// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>

namespace steadyrest::adapters::opcua {

/// Finds out that the control takes orders of somebody else: two layers on one control.
///
/// Heartbeats count from 1 to `period`, one on with each order, then from 1 again. One that the
/// control shows is this layer's if it lies between the one last seen of this layer's and the
/// newest that was sent. Only a heartbeat that has changed counts, and only while this layer sends
/// orders: what was there before it began says nothing.
class OrderWatch {
 public:
  explicit OrderWatch(std::uint32_t period) noexcept : period_(period) {}

  void sent(std::uint32_t heartbeat) noexcept;
  /// The last heartbeat that the control took; NaN: it does not show it.
  void seen(double heartbeat) noexcept;
  /// Three orders of somebody else have been seen.
  [[nodiscard]] bool other() const noexcept { return others_ >= kMostOthers; }

 private:
  static constexpr int kMostOthers = 3;
  static constexpr int kFresh = 50;  ///< readings after an order in which heartbeats are judged

  std::uint32_t period_;
  std::uint32_t from_ = 0;  ///< the oldest that may still be seen; 0: none was sent
  std::uint32_t newest_ = 0;
  double last_ = 0.0;   ///< shown by the reading before
  bool shown_ = false;  ///< there is such a reading
  int fresh_ = 0;
  int others_ = 0;
};

}  // namespace steadyrest::adapters::opcua
