// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <memory>
#include <string>

#include <steadyrest/adapters/linuxcnc/hal_side.hpp>
#include <steadyrest/kernel/outcome/result.hpp>

namespace steadyrest::adapters::linuxcnc {

/// This process as a HAL component beside a LinuxCNC that has loaded layer.hal.
///
/// It reads temperatures (signals `layer-temperature-N`), probe readings (`layer-probe-number`,
/// `-axis`, `-displacement`) and a vibration sensor (sampler channel 7, `layer-vibration-rate`)
/// where the HAL has these signals.
///
/// It has the pins NAME.feed, .spindle, .offset-N, .path-offset-N, .heartbeat, .armed, .hold and
/// .rise, connected to the signals of layer.hal, and attaches to the sampler's channels; its
/// component is NAME-PID. Pins that a killed process left are taken over as they are (HalPins).
/// Destroyed in good order it disarms the watchdog and leaves. Uses liblinuxcnchal alone, which is
/// LGPL.
class HalProcess final : public HalSide {
 public:
  struct Config {
    std::string name = "steadyrest";  ///< of the pins; up to 20 characters
    std::size_t axes = 3;
    double servo_period_s = 0.001;
    double hold_s = 1.0;    ///< without a heartbeat the HAL keeps feed and spindle so long, > 0
    double rise_1_s = 2.0;  ///< then they return to the panel's by this, > 0
    bool writes = true;     ///< false: no pins, reading only
  };

  static kernel::outcome::Result<std::unique_ptr<HalProcess>> make(const Config& config);
  ~HalProcess() override;

  bool read_row(std::size_t channel, Row& row) noexcept override;
  Inputs read_inputs() noexcept override;
  [[nodiscard]] std::size_t waiting(std::size_t channel) const noexcept override;
  void write_pins(const Pins& pins) noexcept override;
  [[nodiscard]] bool offsets_connected() const noexcept override;
  [[nodiscard]] kernel::signal::AxisValues offset_in_force() const noexcept override;
  [[nodiscard]] kernel::signal::AxisValues offset_acceleration() const noexcept override;
  void pause() noexcept override;
  /// Millimetres in one of the machine's linear units, as the HAL file says; without it 1.
  [[nodiscard]] double linear_unit_mm() const noexcept;
  /// Of the vibration sensor; 0: there is none.
  [[nodiscard]] double vibration_rate_hz() const noexcept;

 private:
  struct Hal;
  explicit HalProcess(std::unique_ptr<Hal> hal) noexcept;

  std::unique_ptr<Hal> hal_;
};

}  // namespace steadyrest::adapters::linuxcnc
