// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstddef>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include <hal.h>

#include <steadyrest/kernel/outcome/result.hpp>
#include <steadyrest/kernel/signal/frame.hpp>

namespace steadyrest::adapters::linuxcnc {

/// Of a signal that a HAL file set; nothing where there is none of this name. Not by a pin: linking
/// the first one would overwrite the value.
[[nodiscard]] std::optional<double> signal_value(const std::string& name);

/// Values of the layer's pins.
struct PinValues {
  struct Axis {
    hal_data_u* offset;
    hal_data_u* path_offset;
  };
  hal_data_u* feed;
  hal_data_u* spindle;
  hal_data_u* heartbeat;
  hal_data_u* armed;
  hal_data_u* hold;           ///< s without a heartbeat until the HAL takes the layer for dead
  hal_data_u* rise;           ///< 1/s by which it hands back then
  hal_data_u* process;        ///< whose the pins are
  hal_data_u* process_start;  ///< ProcessIdentity::start
  std::array<Axis, kernel::signal::kMaxAxes> axis;
  std::array<hal_data_u*, kernel::signal::kMaxTemperatures> temperature;
  hal_data_u* probe_number;
  hal_data_u* probe_axis;
  hal_data_u* probe_displacement;
};

/// The layer's pins NAME.feed, NAME.spindle, … and their connection to the signals `layer-…`.
///
/// Pins of a process that was killed stay in the HAL with their values and signals until LinuxCNC
/// ends. The next process uses the same ones and goes on from what they hold. HAL's memory (300 kB)
/// would be full after some fifty kills if each process made its own. Pins of a process that runs
/// are refused, and so is a layer whose heartbeat the watchdog still sees.
class HalPins {
 public:
  /// For a component that is not ready yet.
  static kernel::outcome::Result<HalPins> make(const std::string& name, std::size_t axes,
                                               int component);

  /// Once the component is ready.
  kernel::outcome::Result<void> connect();

  [[nodiscard]] const PinValues& values() const noexcept { return *values_; }
  /// Axes whose offsets are connected; 0: layer_offsets.hal is not loaded.
  [[nodiscard]] std::size_t offsets() const noexcept { return offsets_; }
  [[nodiscard]] bool has_temperature(std::size_t i) const noexcept { return has_temperature_[i]; }
  [[nodiscard]] bool has_probe() const noexcept { return has_probe_; }

 private:
  struct Pin {
    std::string name;
    hal_type_t type;
    hal_pin_dir_t direction;
    hal_data_u** value;
  };

  HalPins(std::string name, std::size_t axes) : name_(std::move(name)), axes_(axes) {}
  [[nodiscard]] std::vector<Pin> list() const;
  void begin();
  kernel::outcome::Result<void> find();
  kernel::outcome::Result<void> claim();
  kernel::outcome::Result<void> link(const std::string& pin);
  kernel::outcome::Result<void> connect_offsets();

  std::string name_;
  std::size_t axes_;
  /// In the HAL's memory, where it rewrites the pointers when pins are linked; those of a killed
  /// process in this one's.
  PinValues* values_ = nullptr;
  std::vector<PinValues> found_;
  std::size_t offsets_ = 0;
  std::array<bool, kernel::signal::kMaxTemperatures> has_temperature_{};
  bool has_probe_ = false;
};

}  // namespace steadyrest::adapters::linuxcnc
