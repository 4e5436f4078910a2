// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>

namespace steadyrest::live {

/// When the next cycle begins.
class Pace {
 public:
  Pace() = default;
  Pace(const Pace&) = delete;
  Pace& operator=(const Pace&) = delete;
  virtual ~Pace() = default;

  struct Wake {
    double lateness_s = 0.0;   ///< wake-up minus deadline, ≥ 0
    std::uint64_t missed = 0;  ///< deadlines that passed while the cycle before was still at work
  };
  /// Waits for the next deadline.
  virtual Wake wait() noexcept = 0;
  /// Time since any fixed instant, s.
  [[nodiscard]] virtual double now_s() const noexcept = 0;
};

/// Absolute deadlines t₀ + n·T of CLOCK_MONOTONIC; t₀ is the first call of wait().
class MonotonicPace final : public Pace {
 public:
  /// `period_s` > 0.
  explicit MonotonicPace(double period_s) noexcept;
  Wake wait() noexcept override;
  [[nodiscard]] double now_s() const noexcept override;

 private:
  std::int64_t period_ns_;
  std::int64_t deadline_ns_ = 0;  ///< none yet
};

}  // namespace steadyrest::live
