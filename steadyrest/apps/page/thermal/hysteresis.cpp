// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <cmath>
#include <map>
#include <utility>

#include <steadyrest/apps/page/thermal/hysteresis.hpp>

namespace steadyrest::apps::page {
namespace {

using thermal::offline::Log;
using thermal::offline::LogChannel;

/// A spindle under load breathes by a per cent or two.
constexpr double kSameSpeed = 0.02;  ///< of it: noise of the reading
/// Below half a revolution per second the spindle is at rest.
constexpr double kStandstill_rev_s = 0.5;
constexpr double kShortest_s = 300.0;  ///< shorter stretches are no regime
/// Displacements at "one temperature": within half a kelvin.
constexpr double kCell_c = 0.5;

using Pairs = std::vector<std::pair<double, double>>;  ///< °C, mm

/// Readings present on both sides; sensors drop out now and then.
Pairs pairs_of(const LogChannel& sensor, const LogChannel& channel) {
  Pairs out;
  out.reserve(channel.value.size());
  for (std::size_t i = 0; i < channel.value.size(); ++i) {
    if (std::isfinite(sensor.value[i]) && std::isfinite(channel.value[i])) {
      out.emplace_back(sensor.value[i], channel.value[i]);
    }
  }
  return out;
}

/// Least squares: slope = cov/var; the residual is var(d) − slope·cov. Means first, then
/// deviations: sums of raw squares would cancel.
void put_line(const Pairs& pairs, Hysteresis& out) {
  const auto n = static_cast<double>(pairs.size());
  for (const auto& [c, mm] : pairs) {
    out.mean_c += c / n;
    out.mean_mm += mm / n;
  }
  double cc = 0.0;
  double dd = 0.0;
  double cd = 0.0;
  for (const auto& [c, mm] : pairs) {
    cc += (c - out.mean_c) * (c - out.mean_c) / n;
    dd += (mm - out.mean_mm) * (mm - out.mean_mm) / n;
    cd += (c - out.mean_c) * (mm - out.mean_mm) / n;
  }
  out.slope_mm_k = cc > 0.0 ? cd / cc : 0.0;
  out.correlation = cc > 0.0 && dd > 0.0 ? cd / std::sqrt(cc * dd) : 0.0;
  out.residual_mm = std::sqrt(std::max(dd - out.slope_mm_k * cd, 0.0));
}

/// The largest range of displacement within one temperature cell: the worst error that a correction
/// by this sensor alone would make.
void put_spread(const Pairs& pairs, Hysteresis& out) {
  std::map<long, std::pair<double, double>> cells;
  for (const auto& [c, mm] : pairs) {
    const auto [cell, fresh] = cells.try_emplace(std::lround(c / kCell_c), mm, mm);
    cell->second.first = std::min(cell->second.first, mm);
    cell->second.second = std::max(cell->second.second, mm);
  }
  for (const auto& [cell, ends] : cells) {
    if (ends.second - ends.first > out.spread_mm) {
      out.spread_mm = ends.second - ends.first;
      out.spread_at_c = kCell_c * static_cast<double>(cell);
      out.spread_from_mm = ends.first;
    }
  }
}

}  // namespace

/// A regime is a stretch at one speed of five minutes or more.
std::vector<Regime> regimes_of(const Log& log, std::size_t points) {
  std::vector<Regime> out;
  for (std::size_t i = 0; i < log.rows();) {
    const double speed = log.speed_rev_s[i];
    std::size_t end = i + 1;
    while (end < log.rows() && std::abs(log.speed_rev_s[end] - speed) <=
                                   std::max(kStandstill_rev_s, kSameSpeed * speed)) {
      ++end;
    }
    Regime regime{.speed_rev_s = speed,
                  .start_s = log.time_s[i],
                  .seconds = log.time_s[end - 1] - log.time_s[i],
                  .row = {}};
    if (regime.seconds >= kShortest_s) {
      // Thinned evenly; the first row is always included.
      const std::size_t step = (end - i - 1) / std::max<std::size_t>(points, 1) + 1;
      for (std::size_t row = i; row < end; row += step) {
        regime.row.push_back(row);
      }
      out.push_back(std::move(regime));
    }
    i = end;
  }
  return out;
}

/// Every sensor is judged by the same rule, so the best is the best that a one-sensor correction
/// could use.
std::vector<Hysteresis> hysteresis_of(const Log& log, const LogChannel& channel) {
  std::vector<Hysteresis> out;
  out.reserve(log.temperature.size());
  for (const LogChannel& sensor : log.temperature) {
    Hysteresis one;
    one.sensor = sensor.name;
    const Pairs pairs = pairs_of(sensor, channel);
    put_line(pairs, one);
    put_spread(pairs, one);
    out.push_back(std::move(one));
  }
  return out;
}

/// By |correlation|: a sensor that falls while the axis grows is as good.
std::size_t best_of(const std::vector<Hysteresis>& all) {
  const auto best = std::ranges::max_element(
      all, {}, [](const Hysteresis& one) { return std::abs(one.correlation); });
  return static_cast<std::size_t>(best - all.begin());
}

}  // namespace steadyrest::apps::page
