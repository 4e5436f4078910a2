// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <cmath>
#include <map>
#include <utility>

#include <steadyrest/apps/report/json_numbers.hpp>
#include <steadyrest/apps/thermal_page/hysteresis_page.hpp>
#include <steadyrest/kernel/units/convert.hpp>

namespace steadyrest::apps::thermal_page {
namespace {

using thermal::offline::Log;
using thermal::offline::LogChannel;

constexpr double kSameSpeed = 0.02;  ///< of it: noise of the reading
constexpr double kStands_rev_s = 0.5;
constexpr double kShortest_s = 300.0;  ///< shorter stretches are no regime
constexpr double kCell_c = 0.5;

double correlation(const std::vector<double>& x, const std::vector<double>& y) {
  double n = 0.0;
  double sx = 0.0;
  double sy = 0.0;
  double sxx = 0.0;
  double syy = 0.0;
  double sxy = 0.0;
  for (std::size_t i = 0; i < x.size(); ++i) {
    if (!std::isfinite(x[i]) || !std::isfinite(y[i])) {
      continue;
    }
    n += 1.0;
    sx += x[i];
    sy += y[i];
    sxx += x[i] * x[i];
    syy += y[i] * y[i];
    sxy += x[i] * y[i];
  }
  const double both = (n * sxx - sx * sx) * (n * syy - sy * sy);
  return both > 0.0 ? (n * sxy - sx * sy) / std::sqrt(both) : 0.0;
}

/// Rows from … to of one speed.
std::vector<std::pair<std::size_t, std::size_t>> stretches(const Log& log) {
  std::vector<std::pair<std::size_t, std::size_t>> out;
  for (std::size_t i = 0; i < log.rows();) {
    const double speed = log.speed_rev_s[i];
    std::size_t end = i + 1;
    while (end < log.rows() &&
           std::abs(log.speed_rev_s[end] - speed) <= std::max(kStands_rev_s, kSameSpeed * speed)) {
      ++end;
    }
    if (log.time_s[end - 1] - log.time_s[i] >= kShortest_s) {
      out.emplace_back(i, end);
    }
    i = end;
  }
  return out;
}

double spread_mm(const std::vector<double>& temperature_c, const std::vector<double>& mm) {
  std::map<long, std::pair<double, double>> cells;
  for (std::size_t i = 0; i < mm.size(); ++i) {
    if (std::isfinite(temperature_c[i]) && std::isfinite(mm[i])) {
      const auto [cell, fresh] =
          cells.try_emplace(std::lround(temperature_c[i] / kCell_c), mm[i], mm[i]);
      cell->second.first = std::min(cell->second.first, mm[i]);
      cell->second.second = std::max(cell->second.second, mm[i]);
    }
  }
  double most = 0.0;
  for (const auto& [cell, ends] : cells) {
    most = std::max(most, ends.second - ends.first);
  }
  return most;
}

}  // namespace

std::vector<Hysteresis> hysteresis_of(const Log& log, std::size_t points) {
  std::vector<Hysteresis> out;
  for (const LogChannel& channel : log.displacement) {
    const LogChannel* best = nullptr;
    Hysteresis one;
    for (const LogChannel& sensor : log.temperature) {
      const double found = correlation(sensor.value, channel.value);
      if (best == nullptr || std::abs(found) > std::abs(one.correlation)) {
        best = &sensor;
        one.correlation = found;
      }
    }
    if (best == nullptr) {
      return {};
    }
    one.channel = channel.name;
    one.sensor = best->name;
    one.spread_mm = spread_mm(best->value, channel.value);
    for (const auto& [from, to] : stretches(log)) {
      Hysteresis::Stretch stretch{.speed_rev_s = log.speed_rev_s[from],
                                  .start_s = log.time_s[from],
                                  .seconds = log.time_s[to - 1] - log.time_s[from],
                                  .temperature_c = {},
                                  .displacement_mm = {}};
      const std::size_t step =
          std::max<std::size_t>((to - from) / std::max<std::size_t>(points, 1), 1);
      for (std::size_t i = from; i < to; i += step) {
        stretch.temperature_c.push_back(best->value[i]);
        stretch.displacement_mm.push_back(channel.value[i]);
      }
      one.stretch.push_back(std::move(stretch));
    }
    out.push_back(std::move(one));
  }
  return out;
}

std::string hysteresis_page(const Json& answer, const Log& log) {
  Json page = page_head("hysteresis", log.file, answer);
  page["hours"] = log.hours();
  page["channels"] = Json::array();
  for (const Hysteresis& one : hysteresis_of(log)) {
    Json channel = {{"channel", one.channel},
                    {"sensor", one.sensor},
                    {"correlation", one.correlation},
                    {"spread_um", kernel::units::um_from_mm(one.spread_mm)},
                    {"stretches", Json::array()}};
    for (const Hysteresis::Stretch& stretch : one.stretch) {
      std::vector<double> um = stretch.displacement_mm;
      std::ranges::transform(um, um.begin(), kernel::units::um_from_mm);
      channel["stretches"].push_back(
          {{"speed_rpm", std::round(kernel::units::rpm_from_rev_s(stretch.speed_rev_s))},
           {"start_min", stretch.start_s / 60.0},
           {"minutes", stretch.seconds / 60.0},
           {"temperature_c", report::short_numbers(stretch.temperature_c)},
           {"displacement_um", report::short_numbers(um)}});
    }
    page["channels"].push_back(std::move(channel));
  }
  return text_of(page);
}

}  // namespace steadyrest::apps::thermal_page
