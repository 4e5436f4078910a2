// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <limits>

#include <steadyrest/kernel/machine/links/opcua.hpp>
#include <steadyrest/kernel/signal/path.hpp>

namespace steadyrest::adapters::opcua {

inline constexpr std::size_t kQuantities = kernel::machine::kQuantityWords.size();
inline constexpr std::size_t kLongestName = 160;

/// What the control's server shows at one time, in the units of the quantities' names.
struct Reading {
  Reading() noexcept {
    value.fill(std::numeric_limits<double>::quiet_NaN());
    for (auto& one : axis) {
      one.fill(std::numeric_limits<double>::quiet_NaN());
    }
  }
  [[nodiscard]] double operator[](kernel::machine::Quantity quantity) const noexcept {
    return value[static_cast<std::size_t>(quantity)];
  }
  [[nodiscard]] double operator()(kernel::machine::Quantity quantity,
                                  std::size_t of_axis) const noexcept {
    return axis[of_axis][index_of(quantity)];
  }
  static constexpr std::size_t index_of(kernel::machine::Quantity quantity) noexcept {
    return static_cast<std::size_t>(quantity) -
           static_cast<std::size_t>(kernel::machine::Quantity::command_mm);
  }

  std::array<double, kQuantities> value{};                             ///< NaN: not known
  std::array<std::array<double, 4>, kernel::signal::kMaxAxes> axis{};  ///< likewise
  double source_s = std::numeric_limits<double>::quiet_NaN();          ///< by the server
  std::array<char, kLongestName + 1> program{};                        ///< ends in 0
};

/// Heartbeats go from 1 to this and begin again: a REAL keeps whole numbers up to 16777216.
inline constexpr std::uint32_t kHeartbeats = 1000000;
/// Likewise where a PLC takes a byte.
inline constexpr std::uint32_t kHeartbeatBytes = 250;

[[nodiscard]] constexpr std::uint32_t heartbeat_byte(std::uint32_t heartbeat) noexcept {
  return 1 + heartbeat % kHeartbeatBytes;
}

/// What the layer wants of the control's side.
struct Order {
  std::uint32_t heartbeat = 0;
  bool masks_feed = false;
  bool masks_spindle = false;
  bool has_offsets = false;
  double feed_percent = 100.0;
  double spindle_percent = 100.0;
  std::uint32_t feed_position = 0;  ///< of the switch, 1 is the first; 0: none
  std::uint32_t spindle_position = 0;
  kernel::signal::AxisValues offset_mm{};  ///< deg of a rotary axis
};

}  // namespace steadyrest::adapters::opcua
