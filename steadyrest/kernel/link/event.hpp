// SPDX-License-Identifier: Apache-2.0
#pragma once

namespace steadyrest::kernel::link {

/// Counts what one thread tells another; whoever waits sleeps meanwhile. No lock, no allocation
/// after construction.
class Event {
 public:
  Event() noexcept;
  Event(const Event&) = delete;
  Event& operator=(const Event&) = delete;
  ~Event();

  /// From any thread.
  void post() const noexcept;
  /// Takes all that was posted; false: nothing was within the time. One thread. < 0: for ever.
  bool wait(double timeout_s) noexcept;

 private:
  int descriptor_;
};

/// Seconds of CLOCK_MONOTONIC.
[[nodiscard]] double monotonic_s() noexcept;

}  // namespace steadyrest::kernel::link
