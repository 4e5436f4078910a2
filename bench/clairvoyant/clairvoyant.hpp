// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <vector>

/// The yardstick of the feed governor: the best possible override schedule, given full knowledge of
/// the machine, the path and every error. Offline only; the product never calls it.
namespace steadyrest::bench::clairvoyant {

/// What happens on one short stretch of path when the whole program runs at one constant step.
struct Station {
  double length_mm = 0.0;
  std::vector<double> time_s;    ///< by step: time that the stretch takes
  std::vector<double> error_mm;  ///< by step: largest |contour error| on the stretch
};

struct Config {
  std::vector<double> ratio;  ///< override table, ascending
  double limit_mm = 0.010;
  double min_ratio = 0.10;
  double max_ratio = 1.0;
  double start_ratio = 1.0;
  double fall_1_s = 10.0;
  double rise_1_s = 2.0;
  double grid_ratio = 0.001;  ///< resolution of the slewed ratio; slew is rounded up to it
};

struct Schedule {
  double time_s = 0.0;            ///< total
  double over_limit_s = 0.0;      ///< time on stretches where no permitted choice kept the limit
  std::vector<std::size_t> step;  ///< by station
};

/// Dynamic programming backwards over the stations. State: the slewed ratio r on a grid; the step
/// in force is the largest one not above r:
///   T_j(r) = t_j(u(r)) + P·[ε_j(u(r)) > limit]·t_j + min { T_{j+1}(r') : r − fall·t_j ≤ r' ≤ r +
///   rise·t_j },  u(r) = floor.
/// P is so large that the limit is exceeded only where there is no alternative. Speed changes are
/// treated as immediate and the slew is rounded up, so T_0 is a lower bound of any real result.
[[nodiscard]] Schedule best_schedule(const std::vector<Station>& stations, const Config& config);

/// Adds as foresight what the dynamic programming ignores: the error of each stretch becomes the
/// largest within `ahead_s` after it and `behind_s` before it at the same step, since a speed takes
/// time to change and the axes take time to follow.
[[nodiscard]] std::vector<Station> widened(const std::vector<Station>& stations, double ahead_s,
                                           double behind_s);

}  // namespace steadyrest::bench::clairvoyant
