// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

namespace steadyrest::kernel::machine {

enum class OpcUaSecurity : std::uint8_t {
  sign_and_encrypt,  ///< Basic256Sha256
  none
};

/// What a node of the control means. Percent, mm/min and rpm as controls show them; the adapter
/// converts.
enum class Quantity : std::uint8_t {
  // Read, of the control.
  sample_begin,  ///< number of the control's sample, first in the block
  sample_end,    ///< the same number, last in the block: unlike the first, the block is torn
  time_s,        ///< the control's own clock
  layer_alive,   ///< 1: the control's side obeys the layer
  heartbeat_seen,
  feed_panel_percent,
  feed_effective_percent,
  rapid_panel_percent,
  rapid_effective_percent,
  spindle_panel_percent,
  spindle_effective_percent,
  path_speed_mm_min,
  programmed_feed_mm_min,
  spindle_programmed_rpm,
  spindle_command_rpm,
  spindle_actual_rpm,
  motion_g,       ///< active G code of group 1: 0, 1, 2, 3, 33, …
  motion_number,  ///< the same by its number in the group: 1 for G0, 2 for G1, …
  program_state,  ///< 0 stopped, 1 paused, 2 running; by `states` of the mapping
  program_line,
  program_name,
  coolant,
  modulation,  ///< the program asks for spindle speed modulation
  // Read, of each axis.
  command_mm,
  actual_mm,
  following_error_mm,
  offset_mm,
  // Written.
  heartbeat,       ///< changes with each order
  heartbeat_copy,  ///< the same, last in the block: unlike the first, the order is torn
  masks_feed,      ///< 1: feed_percent counts
  masks_spindle,   ///< likewise
  has_offsets,     ///< likewise
  feed_percent,
  spindle_percent,
  axis_offset_mm,  ///< of each axis
  // Written to a PLC in bytes.
  heartbeat_byte,    ///< 1 … 250, another one with each order
  mask_byte,         ///< 1 feed, 2 spindle, both: 3
  feed_position,     ///< of the feed switch, 1 is the first
  spindle_position,  ///< likewise
};

/// In the order of their values.
inline constexpr std::array<std::string_view, 39> kQuantityWords = {"sample_begin",
                                                                    "sample_end",
                                                                    "time_s",
                                                                    "layer_alive",
                                                                    "heartbeat_seen",
                                                                    "feed_panel_percent",
                                                                    "feed_effective_percent",
                                                                    "rapid_panel_percent",
                                                                    "rapid_effective_percent",
                                                                    "spindle_panel_percent",
                                                                    "spindle_effective_percent",
                                                                    "path_speed_mm_min",
                                                                    "programmed_feed_mm_min",
                                                                    "spindle_programmed_rpm",
                                                                    "spindle_command_rpm",
                                                                    "spindle_actual_rpm",
                                                                    "motion_g",
                                                                    "motion_number",
                                                                    "program_state",
                                                                    "program_line",
                                                                    "program_name",
                                                                    "coolant",
                                                                    "modulation",
                                                                    "command_mm",
                                                                    "actual_mm",
                                                                    "following_error_mm",
                                                                    "offset_mm",
                                                                    "heartbeat",
                                                                    "heartbeat_copy",
                                                                    "masks_feed",
                                                                    "masks_spindle",
                                                                    "has_offsets",
                                                                    "feed_percent",
                                                                    "spindle_percent",
                                                                    "axis_offset_mm",
                                                                    "heartbeat_byte",
                                                                    "mask_byte",
                                                                    "feed_position",
                                                                    "spindle_position"};

[[nodiscard]] constexpr bool is_of_axis(Quantity quantity) noexcept {
  return (quantity >= Quantity::command_mm && quantity <= Quantity::offset_mm) ||
         quantity == Quantity::axis_offset_mm;
}
[[nodiscard]] constexpr bool is_written(Quantity quantity) noexcept {
  return quantity >= Quantity::heartbeat;
}

/// One quantity at one place of the control's server: value = scale · shown + offset. Written the
/// other way round.
struct OpcUaPlace {
  Quantity quantity = Quantity::time_s;
  std::uint8_t axis = 0;
  std::string node;          ///< as in `s=/Channel/Parameter/R[u1,1]`, without placeholders
  std::uint32_t index = 0;   ///< in an array
  std::uint32_t length = 0;  ///< of the array; 0: a single value
  double scale = 1.0;
  double offset = 0.0;

  friend bool operator==(const OpcUaPlace&, const OpcUaPlace&) = default;
};

/// R parameters of the control's side for so many axes (adapters/opcua/control/STEADYREST.SPF).
[[nodiscard]] constexpr std::size_t sample_count(std::size_t axes) noexcept {
  return 11 + 3 * axes;
}
[[nodiscard]] constexpr std::size_t order_count(std::size_t axes) noexcept {
  return 7 + axes;
}
[[nodiscard]] constexpr std::size_t work_count(std::size_t axes) noexcept {
  return 12 + 2 * axes;
}

/// A control that is reached through its OPC UA server, and the mapping of its nodes.
struct OpcUa {
  std::string endpoint;  ///< opc.tcp://HOST:PORT
  std::string user;      ///< empty: anonymous
  std::string password_file;
  std::string password_variable;  ///< of the environment, instead of a file
  OpcUaSecurity security = OpcUaSecurity::sign_and_encrypt;
  std::string certificates;  ///< folder; empty: the user's state folder
  std::string mapping;       ///< file
  double cycle_s = 0.02;     ///< the layer reads and writes this often
  double reply_s = 0.5;      ///< longest wait for the control's answer
  std::uint32_t channel = 1;
  /// The channel's data block in the PLC.
  [[nodiscard]] std::uint32_t channel_db() const noexcept { return 20 + channel; }
  std::uint32_t first_sample = 700;  ///< R parameters that the control's side fills
  std::uint32_t first_order = 760;   ///< R parameters that the layer writes
  std::uint32_t first_work = 780;    ///< R parameters that the control's side works with
  std::uint32_t first_action = 101;  ///< number of its first synchronized action
  double dead_man_s = 1.0;           ///< without a new heartbeat the control's side hands back
  double hand_back_1_s = 2.0;        ///< the feed rises by no more, in the control itself
  std::string spindle = "S1";        ///< as the control calls it
  std::string machine_axes;          ///< names of the machine axes, X1 Y1 …; empty: those
  std::uint32_t plc_block = 170;     ///< DB and FB of STEADYREST.SCL; the next one is the FB's data
  std::uint32_t spindle_axis = 4;    ///< the spindle's machine axis: its DB is 30 + this
  std::string program;  ///< NC program file on this computer; empty: given at the start, or none

  // From the mapping.
  std::string uri;  ///< namespace of all nodes
  std::vector<OpcUaPlace> reads;
  std::vector<OpcUaPlace> writes;
  /// What the control shows for stopped, paused and running; a value that is none: unknown.
  std::array<std::vector<double>, 3> states;

  friend bool operator==(const OpcUa&, const OpcUa&) = default;
};

}  // namespace steadyrest::kernel::machine
