// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>

#include <steadyrest/motion/online/edges/edge_event.hpp>

namespace steadyrest::motion::online {

/// Events between the recorder and its reader, in one context (guard it if an interrupt writes
/// while the loop reads). When full, the oldest event is dropped; the next one read tells how many
/// were.
template <std::size_t Capacity>
class EdgeRing {
  static_assert(Capacity >= 2 && (Capacity & (Capacity - 1)) == 0, "a power of two");

 public:
  constexpr void push(const EdgeEvent& event) noexcept {
    if (size() == Capacity) {
      detail::add_saturated(missing_, std::uint64_t{at(read_).lost} + 1);
      ++read_;
    }
    at(write_) = event;
    ++write_;
  }
  /// The oldest event; false when there is none.
  constexpr bool pop(EdgeEvent& event) noexcept {
    if (size() == 0) {
      return false;
    }
    event = at(read_);
    ++read_;
    detail::add_saturated(event.lost, missing_);
    missing_ = 0;
    return true;
  }
  [[nodiscard]] constexpr std::size_t size() const noexcept { return write_ - read_; }

 private:
  constexpr EdgeEvent& at(std::size_t i) noexcept { return events_[i & (Capacity - 1)]; }

  EdgeEvent events_[Capacity] = {};
  std::size_t read_ = 0;
  std::size_t write_ = 0;
  std::uint32_t missing_ = 0;
};

}  // namespace steadyrest::motion::online
