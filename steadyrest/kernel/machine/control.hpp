// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>

#include <steadyrest/kernel/machine/dialect.hpp>
#include <steadyrest/kernel/machine/unlimited.hpp>

namespace steadyrest::kernel::machine {

/// Unit of lengths where a program does not say it.
enum class ProgramUnit : std::uint8_t { unknown, mm, inch };

/// How the control's acceleration rises: with the jerk limits, or at once.
enum class AccelerationMode : std::uint8_t { soft, brisk };

/// LinuxCNC's planners (PLANNER_TYPE): that of 2.9, and those of 2.10 with limited jerk.
enum class LinuxCncPlanner : std::uint8_t { trapezoid, s_curve };

/// How the control plans motion along the path.
struct Control {
  Dialect dialect = Dialect::linuxcnc;
  ProgramUnit units = ProgramUnit::unknown;
  double interpolator_period_s = 0.001;
  double servo_period_s = 0.001;
  double max_path_acceleration_mm_s2 = kUnlimited;  ///< along the path, on top of the axes' own
  double max_path_jerk_mm_s3 = kUnlimited;
  double max_feed_mm_s = kUnlimited;
  double rapid_mm_s = kUnlimited;  ///< path speed of G0, on top of the axes' own
  std::uint32_t look_ahead_blocks = 100;
  double corner_tolerance_mm =
      0.0;  ///< G64 without P; 0 = as fast as the junction allows on the exact path
  double junction_deviation_mm = 0.01;  ///< sets the speed limit at a corner of the exact path
  double tool_change_s = 5.0;
  double centripetal_share = 0.866;  ///< share of the axes' acceleration that arcs may use across
                                     ///< the path; the rest is for speed changes
  double blend_share = 0.5;  ///< a corner arc takes at most this share of each of its neighbours
  double min_block_cycles = 0.0;     ///< a block takes at least this many interpolator periods
  double block_time_s = kUnlimited;  ///< and at least this long; unlimited: not known
  double exact_stop_mm = 0.0;  ///< an exact stop lasts until the axes are within this; 0: no wait
  AccelerationMode acceleration_mode = AccelerationMode::soft;
  LinuxCncPlanner planner = LinuxCncPlanner::trapezoid;
  double merge_share =
      0.0;  ///< lines merge while within this share of the program's own tolerance; 0 = never
  double junction_share =
      1.0;  ///< share of an axis's acceleration that a corner may take in one period at the feed;
            ///< beyond it the exact path stops there (LinuxCNC); 1: no such law
  double corner_acceleration_share =
      1.0;  ///< continuous mode: share of the acceleration available next to a corner that could
            ///< not be rounded and before a stop
  double blend_gap_cycles = 0.0;       ///< what a corner arc leaves of the line before it keeps the
                                       ///< arc's limits when it is shorter than this many periods
  bool clips_programmed_feed = false;  ///< F counts as what the axes permit, before the override
  bool stop_between_rapid_and_feed = false;

  friend bool operator==(const Control&, const Control&) = default;
};

/// What a block takes on the slowest of the older controls.
inline constexpr double kWorstBlockTime_s = 0.02;

/// LinuxCNC takes a block in each period, as min_block_cycles says.
[[nodiscard]] inline bool knows_block_time(const Control& control) noexcept {
  return control.block_time_s != kUnlimited || control.min_block_cycles > 0.0 ||
         control.dialect == Dialect::linuxcnc;
}

/// What a block takes at least: where it is not known, what it takes on the slowest controls.
[[nodiscard]] inline double least_block_s(const Control& control) noexcept {
  const double by_cycles_s = control.min_block_cycles * control.interpolator_period_s;
  if (control.block_time_s != kUnlimited) {
    return control.block_time_s > by_cycles_s ? control.block_time_s : by_cycles_s;
  }
  return knows_block_time(control) ? by_cycles_s : kWorstBlockTime_s;
}

}  // namespace steadyrest::kernel::machine
