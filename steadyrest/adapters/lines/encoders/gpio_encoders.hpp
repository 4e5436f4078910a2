// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <vector>

#include <linux/gpio.h>

#include <steadyrest/adapters/lines/encoders/device_calls.hpp>
#include <steadyrest/adapters/lines/encoders/encoder_source.hpp>
#include <steadyrest/adapters/lines/encoders/quadrature.hpp>
#include <steadyrest/kernel/machine/links/lines.hpp>

namespace steadyrest::adapters::lines {

/// Encoders on lines of a Linux GPIO chip. The kernel stamps and numbers every edge, so that a lost
/// one is seen. libgpiod 1 does not show the numbers: the chip is asked directly
/// (linux/gpio.h, version 2).
class GpioEncoders final : public EncoderSource {
 public:
  /// Takes the lines `recorder.inputs`, A and B in turn. Refused (unavailable): no such chip, a
  /// line that it does not have or that another program has, encoders that move meanwhile.
  [[nodiscard]] static kernel::outcome::Result<std::unique_ptr<GpioEncoders>> open(
      const kernel::machine::Recorder& recorder, const DeviceCalls& calls = {});

  /// All edges until now. Refused: edges were lost, which stays so.
  kernel::outcome::Result<EncoderReading> next() override;

 private:
  GpioEncoders(Descriptor lines, std::vector<std::uint32_t> inputs);
  kernel::outcome::Result<void> settle(const DeviceCalls& calls);
  kernel::outcome::Result<bool> refill();
  kernel::outcome::Result<void> take_until(std::uint64_t now_ns);
  kernel::outcome::Result<void> take(const gpio_v2_line_event& event);

  Descriptor lines_;
  std::vector<std::uint32_t> inputs_;
  std::array<Quadrature, kMostCounters> encoder_;
  std::uint64_t start_ns_ = 0;
  std::uint32_t sequence_ = 0;
  /// Read, but not yet taken: an edge later than the reading belongs to the next one.
  std::array<gpio_v2_line_event, 64> event_{};
  std::size_t taken_ = 0;
  std::size_t filled_ = 0;
  EncoderReading now_;
  kernel::outcome::Refusal fault_;  ///< none: no words
};

}  // namespace steadyrest::adapters::lines
