// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <cmath>
#include <cstdint>
#include <deque>

#include <bench/clairvoyant/clairvoyant.hpp>

// The yardstick of the feed governor. The state is the slewed ratio, the stage is the stretch of
// path, and costs add up backwards, so each stretch is visited once per level. O(stations · levels)
// thanks to the sliding window of relax().
namespace steadyrest::bench::clairvoyant {
namespace {

/// A second over the limit costs as much as ten thousand seconds: the limit is exceeded only where
/// no permitted choice keeps it.
constexpr double kPenalty = 1e4;

/// The slewed ratio's grid and the step that each of its points puts in force.
struct Grid {
  double spacing;
  std::vector<std::size_t> step;
};

Grid make_grid(const Config& config) {
  Grid grid{config.grid_ratio, {}};
  const auto first = static_cast<std::size_t>(std::llround(config.min_ratio / grid.spacing));
  const auto last = static_cast<std::size_t>(std::llround(config.max_ratio / grid.spacing));
  for (std::size_t i = first; i <= last; ++i) {
    const double ratio = static_cast<double>(i) * grid.spacing;
    // The step in force is the largest one not above the ratio, as the envelope floors it.
    const auto above = std::ranges::upper_bound(config.ratio, ratio + 0.5 * grid.spacing);
    const auto count = static_cast<std::size_t>(above - config.ratio.begin());
    grid.step.push_back(count == 0 ? 0 : count - 1);
  }
  return grid;
}

/// Rounded up: the slew of the schedule is never slower than the machine's, so the result stays a
/// lower bound.
std::size_t cells(double ratio_change, double spacing) {
  return static_cast<std::size_t>(std::ceil(ratio_change / spacing));
}

/// One step's band of the grid at one station: all its points share time, error and reach.
struct Band {
  std::size_t first = 0;  ///< level
  std::size_t end = 0;
  double cost = 0.0;
  std::size_t down = 0;
  std::size_t up = 0;
};

/// For every level of the band its cost and the cheapest level within reach. The window slides
/// upwards with the level, and the deque keeps its minima in rising order: each level enters and
/// leaves once. Of equal costs the highest wins, the one that an operator would expect.
void relax(const Band& band, const std::vector<double>& cost_ahead, std::vector<double>& cost_here,
           std::vector<std::uint16_t>& choice) {
  std::deque<std::size_t> rising;  // levels of rising cost; the front is the cheapest
  std::size_t entered = band.first - std::min(band.first, band.down);
  for (std::size_t r = band.first; r < band.end; ++r) {
    for (; entered <= std::min(cost_ahead.size() - 1, r + band.up); ++entered) {
      while (!rising.empty() && cost_ahead[rising.back()] >= cost_ahead[entered]) {
        rising.pop_back();
      }
      rising.push_back(entered);
    }
    while (rising.front() + band.down < r) {
      rising.pop_front();
    }
    cost_here[r] = band.cost + cost_ahead[rising.front()];
    choice[r] = static_cast<std::uint16_t>(rising.front());
  }
}

}  // namespace

/// Backwards for the costs, then forwards along the choices.
Schedule best_schedule(const std::vector<Station>& stations, const Config& config) {
  const Grid grid = make_grid(config);
  const std::size_t levels = grid.step.size();
  std::vector<double> cost_ahead(levels, 0.0);
  std::vector<double> cost_here(levels, 0.0);
  std::vector<std::vector<std::uint16_t>> choice(stations.size(),
                                                 std::vector<std::uint16_t>(levels));
  for (std::size_t j = stations.size(); j-- > 0;) {
    // Levels that put the same step in force share time, error and reach; they are one band.
    for (std::size_t first = 0, end = 0; first < levels; first = end) {
      const std::size_t step = grid.step[first];
      while (end < levels && grid.step[end] == step) {
        ++end;
      }
      const double time = stations[j].time_s[step];
      const bool over = stations[j].error_mm[step] > config.limit_mm;
      relax({.first = first,
             .end = end,
             .cost = time * (over ? 1.0 + kPenalty : 1.0),
             .down = cells(config.fall_1_s * time, grid.spacing),
             .up = cells(config.rise_1_s * time, grid.spacing)},
            cost_ahead, cost_here, choice[j]);
    }
    std::swap(cost_ahead, cost_here);
  }
  // The ratio that is in force when the program starts.
  const double offset = (config.start_ratio - config.min_ratio) / grid.spacing;
  std::size_t r =
      std::min(levels - 1, static_cast<std::size_t>(std::llround(std::max(0.0, offset))));
  Schedule schedule;
  for (std::size_t j = 0; j < stations.size(); ++j) {
    const std::size_t step = grid.step[r];
    schedule.step.push_back(step);
    schedule.time_s += stations[j].time_s[step];
    if (stations[j].error_mm[step] > config.limit_mm) {
      schedule.over_limit_s += stations[j].time_s[step];
    }
    r = choice[j][r];
  }
  return schedule;
}

/// Adds as foresight what the dynamic programming ignores: a change of speed takes time and the
/// axes lag, so a fast stretch just before a tight one spoils it.
std::vector<Station> widened(const std::vector<Station>& stations, double ahead_s,
                             double behind_s) {
  std::vector<Station> wide = stations;
  const std::size_t steps = stations.empty() ? 0 : stations.front().time_s.size();
  // A step never run takes no time anywhere: its window would be the whole path.
  std::vector<std::size_t> run;
  for (std::size_t u = 0; u < steps; ++u) {
    if (std::ranges::any_of(stations, [u](const Station& s) { return s.time_s[u] > 0.0; })) {
      run.push_back(u);
    }
  }
  for (std::size_t j = 0; j < stations.size(); ++j) {
    for (const std::size_t u : run) {
      double& error_mm = wide[j].error_mm[u];
      double passed_s = 0.0;
      for (std::size_t i = j; i < stations.size() && passed_s <= ahead_s; ++i) {
        error_mm = std::max(error_mm, stations[i].error_mm[u]);
        passed_s += stations[i].time_s[u];
      }
      passed_s = 0.0;
      for (std::size_t i = j; i-- > 0 && passed_s <= behind_s;) {
        passed_s += stations[i].time_s[u];
        error_mm = std::max(error_mm, passed_s <= behind_s ? stations[i].error_mm[u] : 0.0);
      }
    }
  }
  return wide;
}

}  // namespace steadyrest::bench::clairvoyant
