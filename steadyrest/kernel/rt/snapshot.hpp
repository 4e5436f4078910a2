// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <atomic>
#include <cstdint>
#include <type_traits>

#include <steadyrest/kernel/rt/ring.hpp>

namespace steadyrest::kernel::rt {

/// The latest value, from one writer to one reader: a triple buffer.
///
/// The writer never waits and never fails; the reader gets the newest whole value and never a torn
/// one. Values that nobody fetched are lost, which is the point. Three slots: one is the writer's,
/// one the reader's; `middle_` names the third and tells whether it is new. Each side exchanges its
/// own slot for the middle one in a single atomic step. Both sides are wait-free.
template <class T>
class Snapshot {
  static_assert(std::is_nothrow_copy_assignable_v<T> && std::is_default_constructible_v<T>);

 public:
  /// Writer only.
  void store(const T& value) noexcept {
    slots_[write_].value = value;
    write_ = middle_.exchange(write_ | kFresh, std::memory_order_acq_rel) & kIndex;
  }

  /// Reader only: fetches the newest value into `get()`; false when nothing came since the last.
  bool refresh() noexcept {
    if ((middle_.load(std::memory_order_relaxed) & kFresh) == 0) {
      return false;
    }
    read_ = middle_.exchange(read_, std::memory_order_acq_rel) & kIndex;
    return true;
  }
  /// Reader only: the value of the last refresh(); T{} before the first. Stays until the next one.
  [[nodiscard]] const T& get() const noexcept { return slots_[read_].value; }
  /// Reader only: both at once.
  [[nodiscard]] const T& load() noexcept {
    refresh();
    return get();
  }

 private:
  static constexpr std::uint32_t kIndex = 3;
  static constexpr std::uint32_t kFresh = 4;

  struct alignas(kCacheLine) Slot {
    T value{};
  };

  std::array<Slot, 3> slots_{};
  alignas(kCacheLine) std::atomic<std::uint32_t> middle_{1};
  alignas(kCacheLine) std::uint32_t write_ = 0;
  alignas(kCacheLine) std::uint32_t read_ = 2;
};

}  // namespace steadyrest::kernel::rt
