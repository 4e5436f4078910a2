// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>

namespace steadyrest::adapters::opcua {

/// Finds out that the control takes orders of somebody else: two layers on one control.
///
/// Heartbeats count from 1 to `period`, one on with each order, then from 1 again. One that the
/// control shows is this layer's if it lies between the one last seen of this layer's and the
/// newest that was sent. Only a heartbeat that has changed counts, only while this layer sends
/// orders, and not where they have gone round since the last one was seen. Three of somebody else's
/// are another layer, unless 50 readings without one lie between them: an order of a dead
/// connection may come late.
class OrderWatch {
 public:
  explicit OrderWatch(std::uint32_t period) noexcept : period_(period) {}

  void sent(std::uint32_t heartbeat) noexcept;
  /// What the control shows as the last heartbeat taken; NaN: it does not show it.
  void seen(double heartbeat) noexcept;
  /// There is another layer; for good.
  [[nodiscard]] bool other() const noexcept { return others_ >= kMostOthers; }

 private:
  static constexpr int kMostOthers = 3;
  static constexpr int kReadings = 50;

  [[nodiscard]] std::uint32_t way(std::uint32_t to) const noexcept {
    return (to + period_ - from_) % period_;
  }

  std::uint32_t period_;
  std::uint32_t from_ = 0;  ///< the oldest that may still be seen
  std::uint32_t newest_ = 0;
  std::uint32_t ahead_ = 0;  ///< orders from the oldest to the newest
  double last_ = 0.0;        ///< shown by the reading before
  bool shown_ = false;       ///< there is such a reading
  int fresh_ = 0;            ///< readings in which heartbeats are judged, after an order
  int others_ = 0;
  int without_ = 0;  ///< readings since the last one of somebody else's
};

}  // namespace steadyrest::adapters::opcua
