// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <span>
#include <vector>

#include <steadyrest/thermal/offline/log/log.hpp>

/// Levels of a mode as a table over the spindle's speed: 0 at 0 rpm, linear from speed to speed,
/// constant beyond the last one.
namespace steadyrest::thermal::offline {

/// The speeds at which the spindle has turned long enough to determine a level, ascending: 20 min
/// in all, speeds within 3 % counting as one (their mean over time).
[[nodiscard]] std::vector<double> held_speeds_rev_s(const Log& log, double from_s, double to_s);

inline constexpr double kHeld_s = 20.0 * 60.0;
/// With fewer speeds a straight line or a parabola fits as well; with more a table makes no sense.
inline constexpr std::size_t kLeastSpeeds = 3;
inline constexpr std::size_t kMostSpeeds = 16;

/// The value at this speed of a level of 1 at speed `k` of the table and 0 at the others.
[[nodiscard]] double table_share(std::span<const double> table_rev_s, std::size_t k,
                                 double speed_rev_s);

}  // namespace steadyrest::thermal::offline
