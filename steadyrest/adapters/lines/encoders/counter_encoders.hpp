// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <filesystem>
#include <map>
#include <memory>
#include <vector>

#include <steadyrest/adapters/lines/encoders/device_calls.hpp>
#include <steadyrest/adapters/lines/encoders/encoder_source.hpp>
#include <steadyrest/kernel/machine/links/lines.hpp>

namespace steadyrest::adapters::lines {

/// Encoders on the kernel's counters (quadrature inputs of a processor, counter cards). A count is
/// read from sysfs; its last edge has a time where the counter's driver tells of each change
/// (linux/counter.h).
class CounterEncoders final : public EncoderSource {
 public:
  /// `recorder.inputs`: number of the counter and of its count, in turn. Refused (unavailable): no
  /// such count, one that is switched off or does not know the direction.
  [[nodiscard]] static kernel::outcome::Result<std::unique_ptr<CounterEncoders>> open(
      const kernel::machine::Recorder& recorder, const DeviceCalls& calls = {});

  /// Refused: a count cannot be read, or moved by more than a quarter of its range at once.
  kernel::outcome::Result<EncoderReading> next() override;

 private:
  struct Count {
    std::filesystem::path folder;
    std::uint32_t counter = 0;
    std::uint32_t number = 0;  ///< of the count within its counter
    Descriptor value;
    std::uint64_t range = 0;  ///< counts until it wraps; 0: 2⁶⁴
    std::uint64_t last = 0;
    std::uint64_t edge_value = 0;
    std::int8_t edge_step = 0;
    std::uint64_t edge_ns = 0;  ///< 0: none yet
  };

  CounterEncoders() = default;
  kernel::outcome::Result<void> add(std::uint32_t counter, std::uint32_t number,
                                    const DeviceCalls& calls);
  void watch(const DeviceCalls& calls);
  void take_events(std::uint32_t counter, const Descriptor& events) noexcept;
  [[nodiscard]] static kernel::outcome::Result<std::uint64_t> value_of(const Count& count);

  std::vector<Count> counts_;
  std::map<std::uint32_t, Descriptor> events_;  ///< of the counters that tell of changes
  std::uint64_t start_ns_ = 0;
  EncoderReading now_;
  kernel::outcome::Refusal fault_;  ///< none: no words
};

}  // namespace steadyrest::adapters::lines
