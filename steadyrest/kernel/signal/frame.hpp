// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <limits>
#include <span>

#include <steadyrest/kernel/signal/path.hpp>

namespace steadyrest::kernel::signal {

/// One axis as its control reports it in one cycle, with the motion room's estimates from its
/// counter.
///
/// A latching counter gives its count and the time of the last edge. Line n is the border between
/// the counts n − 1 and n; with counts of length q the reading `actual_mm` is q·count, so line n
/// lies at q·(n − ½).
struct AxisSample {
  double command_mm = 0.0;          ///< commanded position
  double actual_mm = 0.0;           ///< position by the encoder
  double following_error_mm = 0.0;  ///< command − actual, as the control reports it; shown as
                                    ///< Ed, no decision uses it
  double offset_mm = 0.0;      ///< in force on this axis, a part of both positions; 0 where the
                               ///< control does not show it
  bool encoder_shown = false;  ///< `count` is valid
  std::int64_t count = 0;      ///< of the encoder at `time_s`, ×4 decoded
  /// Time of the last edge up to now, in the frame's time; NaN: none yet, or no time stamps.
  double edge_s = std::numeric_limits<double>::quiet_NaN();
  std::int8_t edge_direction = 0;  ///< +1: that edge raised the count, −1: lowered; 0: not shown

  // Estimates at `time_s`: 0 with infinite bounds until the motion room has filled them in, and
  // where it has none. |true − estimate| ≤ bound as long as the axis keeps within the machine
  // file's limits.
  double velocity_mm_s = 0.0;
  double acceleration_mm_s2 = 0.0;
  double velocity_bound_mm_s = std::numeric_limits<double>::infinity();
  double acceleration_bound_mm_s2 = std::numeric_limits<double>::infinity();
};

/// Override of feed, rapid or spindle as the control reports it.
struct OverrideState {
  double panel_ratio = 1.0;      ///< ratio set on the operator's switch
  double effective_ratio = 1.0;  ///< what is in force now
  std::uint32_t panel_code = 0;  ///< raw code of the switch
  bool panel_code_known = true;  ///< the code is in the machine's table
};

inline constexpr std::size_t kMaxTemperatures = 16;

/// °C, in the order of machine::Thermal::sensors(); NaN: not known.
using Temperatures = std::array<double, kMaxTemperatures>;
[[nodiscard]] constexpr Temperatures unknown_temperatures() noexcept {
  Temperatures none{};
  none.fill(std::numeric_limits<double>::quiet_NaN());
  return none;
}

/// What a probe has measured on a feature of known position: how far the axis is from where it
/// should be, including the offset in force. It stays in the frames until the next one arrives.
struct ProbeReading {
  std::uint64_t number = 0;  ///< counts the readings: each is taken once; 0 = none yet
  std::uint8_t axis = 0;     ///< of the machine
  double displacement_mm = std::numeric_limits<double>::quiet_NaN();
  double sd_mm = 0.0;  ///< standard deviation; 0 = the thermal passport's
};

/// All inputs of one cycle. A plain value; time comes in with it: nothing below has a clock.
struct Frame {
  double time_s = 0.0;  ///< time of the sample, monotone
  double age_s = 0.0;   ///< how old the sample was when it was read
  std::uint64_t cycle = 0;
  std::uint8_t axis_count = 3;
  std::array<AxisSample, kMaxAxes> axis{};
  OverrideState feed;
  OverrideState rapid;
  OverrideState spindle;
  Motion motion = Motion::idle;
  std::uint32_t program_line = 0;
  ProgramState program = ProgramState::unknown;
  double programmed_feed_mm_s = 0.0;      ///< F of the active block at 100 %
  double path_speed_mm_s = 0.0;           ///< commanded path speed now
  bool feed_per_revolution = false;       ///< F follows the spindle by itself
  bool speed_modulation = false;          ///< switched on by the program (M38)
  double spindle_programmed_rev_s = 0.0;  ///< S of the program at 100 %, signed; 0 = stopped
  double spindle_command_rev_s = 0.0;     ///< what the drive is told, override included
  double spindle_actual_rev_s = 0.0;
  bool coolant = false;  ///< on
  Temperatures temperature_c = unknown_temperatures();
  ProbeReading probe;
  /// Readings of a vibration sensor at the spindle since the last frame, oldest first, evenly
  /// sampled up to `time_s`; any unit. Valid as long as the path. Empty: no sensor.
  std::span<const double> vibration;
  double vibration_rate_hz = 0.0;
  PathView path;                  ///< empty when the layer does not know the program's path
  std::size_t path_index = 0;     ///< segment that holds the commanded point
  double path_position_mm = 0.0;  ///< commanded path length since the program's start
  /// The path that the part should have, where the program's text corrects it and so commands
  /// another; empty: they are the same.
  PathView original;
  bool original_unknown = false;  ///< the text corrects the path, from one that is not known
  bool heat_in_text = false;      ///< the text corrects the axes' drift by heat
};

}  // namespace steadyrest::kernel::signal
