// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <cmath>
#include <cstddef>
#include <iterator>

#include <steadyrest/chatter/offline/signal/engagement.hpp>

namespace steadyrest::chatter::offline {
namespace {

constexpr double kAirShare = 0.02;
constexpr double kCutShare = 0.9;
constexpr double kApartDb = 10.0;
constexpr double kLeastRev = 5.0;
constexpr double kBeforeShare = 0.2;  // of the reach: an alarm's time is that of a spectrum's end

double decibel(double energy) {
  return 10.0 * std::log10(std::max(energy, 1e-300));
}

double quantile(std::vector<double> values, double share) {
  const auto at = static_cast<std::ptrdiff_t>(share * static_cast<double>(values.size() - 1));
  std::ranges::nth_element(values, values.begin() + at);
  return values[static_cast<std::size_t>(at)];
}

}  // namespace

std::vector<Engagement> engagements(const std::vector<ForcedLevel>& levels) {
  if (levels.empty()) {
    return {};
  }
  std::vector<double> db;
  std::ranges::transform(levels, std::back_inserter(db),
                         [](const ForcedLevel& level) { return decibel(level.energy); });
  const double air = quantile(db, kAirShare);
  const double cut = quantile(db, kCutShare);
  if (cut - air < kApartDb) {
    return {};
  }
  const double middle = 0.5 * (air + cut);
  std::vector<Engagement> out;
  const auto short_of = [&](double from_s, double to_s, std::size_t i) {
    return (to_s - from_s) * levels[i].speed_rev_s < kLeastRev;
  };
  for (std::size_t i = 0; i < db.size(); ++i) {
    if (db[i] <= middle) {
      continue;
    }
    const std::size_t first = i;
    while (i < db.size() && db[i] > middle) {
      ++i;
    }
    const bool ends = i < db.size();
    const double begin_s = levels[first].t_s;
    const double end_s = levels[ends ? i : i - 1].t_s;
    if (!out.empty() && short_of(out.back().end_s, begin_s, first)) {
      out.back().end_s = end_s;
      out.back().exit = ends;
    } else if (!short_of(begin_s, end_s, first)) {
      out.push_back({.begin_s = begin_s, .end_s = end_s, .entry = first > 0, .exit = ends});
    }
  }
  return out;
}

AtEdge at_edge(const std::vector<Engagement>& cuts, double start_s, double end_s, double within_s) {
  for (const Engagement& cut : cuts) {
    const double before_s = kBeforeShare * within_s;
    if (cut.entry && start_s > cut.begin_s - before_s && end_s < cut.begin_s + within_s) {
      return AtEdge::entry;
    }
    if (cut.exit && start_s > cut.end_s - within_s && end_s < cut.end_s + within_s) {
      return AtEdge::exit;
    }
  }
  return AtEdge::none;
}

}  // namespace steadyrest::chatter::offline
