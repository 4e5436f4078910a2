// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <atomic>
#include <bit>
#include <cstddef>
#include <optional>
#include <type_traits>

namespace steadyrest::kernel::rt {

/// Size of the memory block that two cores contend for.
inline constexpr std::size_t kCacheLine = 64;

/// Ring between one producer and one consumer: nothing is lost unless it is full; order is kept.
///
/// Both sides are wait-free and allocate nothing. A full ring refuses (`try_push` gives false); the
/// producer in the cycle then counts the loss and carries on. Indices run freely and are masked, so
/// that all of Capacity is used.
template <class T, std::size_t Capacity>
class Ring {
  static_assert(std::has_single_bit(Capacity), "the capacity is a power of two");
  static_assert(std::is_nothrow_copy_assignable_v<T> && std::is_default_constructible_v<T>);

 public:
  /// Producer only.
  [[nodiscard]] bool try_push(const T& value) noexcept {
    const std::size_t head = head_.load(std::memory_order_relaxed);
    if (head - tail_seen_ == Capacity) {
      tail_seen_ = tail_.load(std::memory_order_acquire);
      if (head - tail_seen_ == Capacity) {
        return false;
      }
    }
    slots_[head & (Capacity - 1)] = value;
    head_.store(head + 1, std::memory_order_release);
    return true;
  }

  /// Consumer only.
  [[nodiscard]] std::optional<T> try_pop() noexcept {
    const std::size_t tail = tail_.load(std::memory_order_relaxed);
    if (tail == head_seen_) {
      head_seen_ = head_.load(std::memory_order_acquire);
      if (tail == head_seen_) {
        return std::nullopt;
      }
    }
    std::optional<T> value(slots_[tail & (Capacity - 1)]);
    tail_.store(tail + 1, std::memory_order_release);
    return value;
  }

  /// Exact when both sides rest; else a recently valid value.
  [[nodiscard]] std::size_t size() const noexcept {
    const std::size_t tail = tail_.load(std::memory_order_acquire);
    return head_.load(std::memory_order_acquire) - tail;
  }
  [[nodiscard]] static constexpr std::size_t capacity() noexcept { return Capacity; }

 private:
  alignas(kCacheLine) std::atomic<std::size_t> head_{0};
  std::size_t tail_seen_ = 0;  ///< the producer's copy of tail_
  alignas(kCacheLine) std::atomic<std::size_t> tail_{0};
  std::size_t head_seen_ = 0;  ///< the consumer's copy of head_
  alignas(kCacheLine) std::array<T, Capacity> slots_{};
};

}  // namespace steadyrest::kernel::rt
