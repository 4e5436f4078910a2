// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>

#include <steadyrest/adapters/linuxcnc/sample.hpp>

namespace steadyrest::adapters::linuxcnc {

/// What the port needs of LinuxCNC's HAL: HalProcess in earnest, a fake in tests.
class HalSide {
 public:
  HalSide() = default;
  HalSide(const HalSide&) = delete;
  HalSide& operator=(const HalSide&) = delete;
  virtual ~HalSide() = default;

  /// Takes the oldest row that waits in a channel; false: none waits.
  virtual bool read_row(std::size_t channel, Row& row) noexcept = 0;
  /// Temperatures, probe readings and vibration, where the HAL has them.
  virtual Inputs read_inputs() noexcept = 0;
  /// Rows that wait in a channel.
  [[nodiscard]] virtual std::size_t waiting(std::size_t channel) const noexcept = 0;
  virtual void write_pins(const Pins& pins) noexcept = 0;
  /// layer_offsets.hal is loaded.
  [[nodiscard]] virtual bool offsets_connected() const noexcept = 0;
  /// The offset against heat that the HAL has, in the control's units: an earlier layer's at first.
  [[nodiscard]] virtual kernel::signal::AxisValues offset_in_force() const noexcept = 0;
  /// Of each axis for its offset, in the control's units; 0: not known.
  [[nodiscard]] virtual kernel::signal::AxisValues offset_acceleration() const noexcept = 0;
  /// Lets a tenth of a servo period pass.
  virtual void pause() noexcept = 0;
};

}  // namespace steadyrest::adapters::linuxcnc
