// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <atomic>
#include <cstddef>
#include <cstdint>

#include <steadyrest/adapters/linuxcnc/hal_side.hpp>

namespace steadyrest::adapters::linuxcnc {

/// Joins the rows of the sampler's channels that belong to one servo cycle.
///
/// A full channel loses rows, and not every channel the same ones: rows are joined by the tick that
/// the servo thread counts into each channel, and a tick that one channel lacks is left out.
class SampleQueue {
 public:
  enum class Got : std::uint8_t {
    sample,
    none,        ///< nothing waits, or not in every channel
    frozen,      ///< the tick does not change: nothing counts it
    restarted,   ///< the tick went back: another LinuxCNC, or its counter was set
    not_a_tick,  ///< negative, not whole or not a number
  };

  explicit SampleQueue(std::size_t axes) noexcept : axes_(axes), channels_(channels_of(axes)) {}

  /// The oldest complete cycle. Looks at no more than kMostRows rows of each channel.
  Got next(HalSide& hal, Sample& sample) noexcept;

  /// Servo cycles between the first and the last sample that never came.
  [[nodiscard]] std::uint64_t missed() const noexcept { return missed_.load(); }

 private:
  static constexpr std::size_t kMostRows = 65536;

  bool fill(HalSide& hal) noexcept;
  Got take(Sample& sample) noexcept;

  std::size_t axes_;
  std::size_t channels_;
  std::array<Row, kMaxChannels> row_{};
  std::array<bool, kMaxChannels> held_{};
  double last_tick_ = -1.0;
  std::atomic<std::uint64_t> missed_{0};
};

}  // namespace steadyrest::adapters::linuxcnc
