// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>

#include <steadyrest/kernel/signal/frame.hpp>
#include <steadyrest/kernel/signal/path.hpp>

namespace steadyrest::adapters::linuxcnc {

/// Columns of sampler channel 0, as layer.hal connects them.
enum class Column : std::uint8_t {
  tick,  ///< servo cycles since LinuxCNC started
  motion_type,
  program_line,
  path_speed,
  requested_speed,
  feed_mm_s,  ///< F × all that scales it
  spindle_out_rev_s,
  spindle_in_rev_s,
  enabled,
  feed_panel,
  spindle_panel,
  rapid_panel,
  layer_feed,     ///< motion.adaptive-feed in force
  layer_spindle,  ///< behind the ramp
  layer_alive,    ///< the watchdog's verdict
  mode_auto,      ///< a program may run; false: by hand
  program_running,
  program_paused,
  modulation,  ///< a digital output of the program: the spindle's speed may swing
};

/// What the cfg string of the sampler must be for channel 0; u, s, b and f name a pin's type.
inline constexpr const char* kStateTypes = "fssfffffbfffffbbbbb";
inline constexpr std::size_t kStateColumns = 19;

/// The other channels hold the tick and, for each axis, command, actual position, following error
/// and the offset in force. A channel takes 20 pins.
inline constexpr std::size_t kMaxColumns = 20;
inline constexpr std::size_t kAxisColumns = 4;
inline constexpr std::size_t kAxesPerChannel = 4;
inline constexpr std::size_t kMaxChannels = 3;

[[nodiscard]] constexpr std::size_t channels_of(std::size_t axes) noexcept {
  return 1 + (axes + kAxesPerChannel - 1) / kAxesPerChannel;
}

/// Axes in a channel, which is 1 or higher.
[[nodiscard]] constexpr std::size_t axes_in(std::size_t channel, std::size_t axes) noexcept {
  const std::size_t first = (channel - 1) * kAxesPerChannel;
  return axes - first < kAxesPerChannel ? axes - first : kAxesPerChannel;
}

/// One channel's values in one servo cycle; bits are 0 or 1.
using Row = std::array<double, kMaxColumns>;

/// One servo cycle: the rows of all channels with the same tick, in the control's units.
struct Sample {
  std::uint64_t tick = 0;
  Row state{};
  struct Axis {
    double command = 0.0;
    double actual = 0.0;
    double following_error = 0.0;
    double offset = 0.0;
  };
  std::array<Axis, kernel::signal::kMaxAxes> axis{};

  [[nodiscard]] double operator[](Column column) const noexcept {
    return state[static_cast<std::size_t>(column)];
  }
  double& operator[](Column column) noexcept { return state[static_cast<std::size_t>(column)]; }
};

/// What comes without a servo cycle's number.
struct Inputs {
  kernel::signal::Temperatures temperature_c = kernel::signal::unknown_temperatures();
  kernel::signal::ProbeReading probe;  ///< in the control's units
  std::span<const double> vibration;   ///< since the last call; valid until the next
  double vibration_rate_hz = 0.0;
};

/// A feed ratio that no panel reaches: the layer wants nothing.
inline constexpr double kNoCeiling = 10.0;

/// What the adapter tells LinuxCNC.
struct Pins {
  double feed = kNoCeiling;  ///< highest feed ratio; the HAL makes min(this, panel) of it
  double spindle = 1.0;      ///< factor on the speed between spindle.0.speed-out and the drive
  kernel::signal::AxisValues offset{};       ///< in the control's units; kept when the layer dies
  kernel::signal::AxisValues path_offset{};  ///< the same; ramps to 0 when the layer dies
  bool heartbeat = false;
  bool armed = false;  ///< the watchdog watches; a rising edge clears an earlier verdict
};

}  // namespace steadyrest::adapters::linuxcnc
