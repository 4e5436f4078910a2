// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <limits>

#include <steadyrest/adapters/lines/encoders/recorder_message.hpp>
#include <steadyrest/kernel/outcome/result.hpp>

namespace steadyrest::adapters::lines {

/// What to do when counts are no positions any more.
inline constexpr const char* kReference =
    "bring the machine to its reference point and start the layer again";

/// All encoders at one instant.
struct EncoderReading {
  double time_s = 0.0;  ///< by the recorder's clock, from its first sample
  std::size_t counters = 0;
  std::array<std::int64_t, kMostCounters> count{};  ///< since the first sample
  /// Time of the last edge; NaN: none yet.
  std::array<double, kMostCounters> edge_s = [] {
    std::array<double, kMostCounters> none{};
    none.fill(std::numeric_limits<double>::quiet_NaN());
    return none;
  }();
  std::array<std::int8_t, kMostCounters> direction{};
};

/// Where encoders are read.
class EncoderSource {
 public:
  EncoderSource() = default;
  EncoderSource(const EncoderSource&) = delete;
  EncoderSource& operator=(const EncoderSource&) = delete;
  virtual ~EncoderSource() = default;

  /// The newest reading, later than the one before; waits for it a bounded time. Refused
  /// (unavailable): none came, or the counts are no positions any more, which stays so.
  virtual kernel::outcome::Result<EncoderReading> next() = 0;
};

/// Turns the recorder's wrapping figures into times and counts.
class RecorderTrack {
 public:
  /// Refused: counts were lost, the recorder began again or is another one. From then on every
  /// sample is refused with the same words.
  kernel::outcome::Result<EncoderReading> take(const RecorderSample& sample);

 private:
  kernel::outcome::Result<void> check(const RecorderSample& sample) const;

  bool started_ = false;
  RecorderSample last_;
  EncoderReading now_;
  kernel::outcome::Refusal fault_;  ///< none: no words
};

}  // namespace steadyrest::adapters::lines
