// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>

#include <steadyrest/kernel/signal/path.hpp>

namespace steadyrest::nc::plan {

/// What the control's interpolator hands to the servo loops in one cycle.
struct Setpoint {
  kernel::signal::AxisValues position{};  ///< mm or rad, machine coordinates
  kernel::signal::AxisValues velocity{};  ///< per second
  kernel::signal::Motion motion = kernel::signal::Motion::idle;
  std::uint32_t line = 0;
  std::size_t path_index = 0;     ///< segment of the planned path
  double path_position_mm = 0.0;  ///< path length since the program's start
  double path_speed_mm_s = 0.0;
  double programmed_feed_mm_s = 0.0;
  bool feed_per_revolution = false;
  bool speed_modulation = false;  ///< the program asks for spindle speed modulation
  bool coolant = false;           ///< mist, flood or both on
  double spindle_rev_s = 0.0;     ///< commanded, signed, before the spindle override
  bool finished = false;
};

/// The inputs that act on a running control.
struct Overrides {
  double feed_ratio = 1.0;
  double rapid_ratio = 1.0;
  double spindle_actual_rev_s = 0.0;  ///< for waiting on speed and for feed per revolution
  double spindle_ratio = 1.0;         ///< in force at the spindle; a wait for speed counts it
};

}  // namespace steadyrest::nc::plan
