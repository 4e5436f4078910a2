// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <span>
#include <vector>

#include <steadyrest/thermal/offline/log/log.hpp>

/// Levels of a mode as a table over the spindle's speed: 0 at 0 rpm, straight from speed to speed,
/// and beyond the last speed what it is there.
namespace steadyrest::thermal::offline {

/// The speeds at which the spindle has turned for long enough to tell a level of their own, rising:
/// 20 min in all, speeds within 3 % taken as one (their mean over time).
[[nodiscard]] std::vector<double> held_speeds_rev_s(const Log& log, double from_s, double to_s);

inline constexpr double kHeld_s = 20.0 * 60.0;
/// Fewer speeds a straight line or a parabola meets as well; of more a table is no longer one.
inline constexpr std::size_t kLeastSpeeds = 3;
inline constexpr std::size_t kMostSpeeds = 16;

/// What a level of 1 at speed `k` of the table, and of 0 at the others, is at this speed.
[[nodiscard]] double table_share(std::span<const double> table_rev_s, std::size_t k,
                                 double speed_rev_s);

}  // namespace steadyrest::thermal::offline
