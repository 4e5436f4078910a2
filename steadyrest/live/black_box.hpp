// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <string_view>

#include <steadyrest/kernel/outcome/reason.hpp>

namespace steadyrest::live {

/// Tells in which cycle the last seconds of a run are worth keeping apart: where a fault begins.
///
/// Faults: the port cannot be read or written; a frame is unfit (stale, not finite, out of range);
/// a burst of overruns. A fault that lasts is told once; one that begins within `apart_s` of the
/// last of its kind that was told is not: a loose contact must not fill the disk, and a busy
/// computer must not hide a lost link. In the cycle: no allocation.
class BlackBox {
 public:
  struct Config {
    double apart_s = 30.0;     ///< between two of a kind that are told
    std::uint64_t burst = 20;  ///< overruns within `burst_s` that are a fault
    double burst_s = 1.0;
  };

  struct Cycle {
    double now_s = 0.0;  ///< of any clock that runs evenly
    bool port_fault = false;
    kernel::outcome::Reason unfit = kernel::outcome::Reason::none;
    std::uint64_t overruns = 0;  ///< so far
  };

  explicit BlackBox(const Config& config) noexcept : config_(config) {}
  BlackBox() noexcept : BlackBox(Config{}) {}

  /// Why the last seconds should be kept; empty: no reason to.
  std::string_view update(const Cycle& cycle) noexcept;

 private:
  /// One kind of fault.
  struct Kind {
    bool present = false;
    bool told = false;
    double told_s = 0.0;
  };

  [[nodiscard]] bool bursts(const Cycle& cycle) noexcept;
  [[nodiscard]] bool begins(Kind& kind, bool present, double now_s) const noexcept;

  Config config_;
  bool begun_ = false;
  Kind port_;
  Kind unfit_;
  Kind burst_;
  double window_s_ = 0.0;              ///< when the present window began
  std::uint64_t window_overruns_ = 0;  ///< so far, at that time
};

}  // namespace steadyrest::live
