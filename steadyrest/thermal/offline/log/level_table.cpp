// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <utility>

#include <steadyrest/thermal/offline/log/level_table.hpp>

namespace steadyrest::thermal::offline {
namespace {

constexpr double kSameSpeed = 1.03;

}  // namespace

std::vector<double> held_speeds_rev_s(const Log& log, double from_s, double to_s) {
  std::vector<std::pair<double, double>> turned;  // rev/s, s
  for (std::size_t row = 1; row < log.rows(); ++row) {
    const bool inside = log.time_s[row - 1] >= from_s && log.time_s[row] <= to_s;
    if (inside && log.speed_rev_s[row - 1] > 0.0 && !std::ranges::binary_search(log.gap, row)) {
      turned.emplace_back(log.speed_rev_s[row - 1], log.time_s[row] - log.time_s[row - 1]);
    }
  }
  std::ranges::sort(turned);
  std::vector<double> out;
  for (std::size_t i = 0; i < turned.size();) {
    // Speeds waver around their set-point: anything within 3 % above the lowest is one speed, at
    // its mean over time.
    double seconds = 0.0;
    double revolutions = 0.0;
    const double most = kSameSpeed * turned[i].first;
    for (; i < turned.size() && turned[i].first <= most; ++i) {
      seconds += turned[i].second;
      revolutions += turned[i].first * turned[i].second;
    }
    if (seconds >= kHeld_s) {
      out.push_back(revolutions / seconds);
    }
  }
  return out;
}

// A hat function: below the first point it falls to 0 at rest, beyond the last it stays 1.
double table_share(std::span<const double> table_rev_s, std::size_t k, double speed_rev_s) {
  const double here = table_rev_s[k];
  const double below = k == 0 ? 0.0 : table_rev_s[k - 1];
  if (speed_rev_s <= here) {
    return std::max((speed_rev_s - below) / (here - below), 0.0);
  }
  if (k + 1 == table_rev_s.size()) {
    return 1.0;
  }
  return std::max((table_rev_s[k + 1] - speed_rev_s) / (table_rev_s[k + 1] - here), 0.0);
}

}  // namespace steadyrest::thermal::offline
