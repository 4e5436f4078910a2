// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include <steadyrest/kernel/signal/path.hpp>

namespace steadyrest::adapters::lines {

/// Encoders that a recorder can have: the axes and the spindle.
inline constexpr std::size_t kMostCounters = kernel::signal::kMaxAxes + 1;

/// One encoder in one sample of the recorder.
struct CounterSample {
  std::int32_t count = 0;        ///< ×4 decoded; wraps
  std::uint32_t edge_ticks = 0;  ///< recorder's clock at the last edge; wraps
  std::int8_t direction = 0;     ///< of that edge: +1, −1; 0: there was none yet
  bool lost = false;  ///< both channels changed at once since the last sample: counts are missing
};

/// What the recorder sends once a period.
struct RecorderSample {
  std::uint16_t sequence = 0;
  std::uint32_t ticks = 0;     ///< recorder's clock; wraps
  std::uint32_t clock_hz = 0;  ///< ticks in a second
  std::uint8_t counters = 0;
  std::array<CounterSample, kMostCounters> counter{};
};

/// Takes the recorder's messages out of a stream of bytes. README.md has the protocol.
///
/// Any bytes may come: a message counts only if its length and its checksum are right, and the next
/// one begins at the next zero byte. No allocation.
class RecorderParser {
 public:
  struct Counts {
    std::uint64_t samples = 0;
    std::uint64_t broken = 0;   ///< checksum, length or content wrong
    std::uint64_t missing = 0;  ///< by the sequence
  };

  /// The newest sample of these bytes; false: none ended in them. `lost` is that of all samples
  /// and of what `newest` had before: a message that nobody looks at may be the one that tells.
  bool feed(std::span<const std::uint8_t> bytes, RecorderSample& newest) noexcept;
  [[nodiscard]] const Counts& counts() const noexcept { return counts_; }

 private:
  static constexpr std::size_t kLongest = 128;

  [[nodiscard]] bool take(RecorderSample& sample) noexcept;

  std::array<std::uint8_t, kLongest> message_{};  ///< still stuffed
  std::size_t size_ = 0;
  bool too_long_ = false;
  bool started_ = false;
  std::uint16_t sequence_ = 0;
  Counts counts_;
};

/// The message of a sample as a recorder sends it, the zero at its end included.
[[nodiscard]] std::vector<std::uint8_t> message_of(const RecorderSample& sample);

/// CRC-16/CCITT-FALSE: polynomial 0x1021, begins with 0xFFFF.
[[nodiscard]] std::uint16_t crc16(std::span<const std::uint8_t> bytes) noexcept;

}  // namespace steadyrest::adapters::lines
