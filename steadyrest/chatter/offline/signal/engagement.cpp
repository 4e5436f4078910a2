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
constexpr double kLoudShare = 0.1;
constexpr double kBeforeShare = 0.2;  // of the reach: an alarm's time is that of a spectrum's end

double decibel(double energy) {
  return 10.0 * std::log10(std::max(energy, 1e-300));
}

double quantile(std::vector<double> values, double share) {
  const auto at = static_cast<std::ptrdiff_t>(share * static_cast<double>(values.size() - 1));
  std::ranges::nth_element(values, values.begin() + at);
  return values[static_cast<std::size_t>(at)];
}

/// Of levels, `end` the first beyond it.
struct Span {
  std::size_t begin = 0;
  std::size_t end = 0;
};

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
  std::vector<Span> spans;
  const auto short_of = [&](std::size_t from, std::size_t to) {
    return (levels[to].t_s - levels[from].t_s) * levels[from].speed_rev_s < kLeastRev;
  };
  for (std::size_t i = 0; i < db.size(); ++i) {
    if (db[i] <= middle) {
      continue;
    }
    const std::size_t first = i;
    while (i < db.size() && db[i] > middle) {
      ++i;
    }
    if (!spans.empty() && short_of(spans.back().end, first)) {
      spans.back().end = std::min(i, db.size() - 1);
    } else {
      spans.push_back({first, std::min(i, db.size() - 1)});
    }
  }
  std::erase_if(spans, [&](const Span& span) { return short_of(span.begin, span.end); });
  std::vector<Engagement> out;
  for (const Span& span : spans) {
    const double own = quantile({db.begin() + static_cast<std::ptrdiff_t>(span.begin),
                                 db.begin() + static_cast<std::ptrdiff_t>(span.end)},
                                0.5);
    std::size_t end = span.end;
    while (end > span.begin + 1 && db[end - 1] < own - kApartDb) {
      --end;
    }
    out.push_back({.begin_s = levels[span.begin].t_s,
                   .end_s = levels[end].t_s,
                   .entry = span.begin > 0,
                   .exit = end + 1 < db.size(),
                   .energy = std::pow(10.0, 0.1 * own)});
  }
  return out;
}

CutPlace place_of(const std::vector<Engagement>& cuts, const Vibration& vibration,
                  double within_s) {
  const double before_s = kBeforeShare * within_s;
  bool within = cuts.empty();
  double loudest = 0.0;
  for (const Engagement& cut : cuts) {
    if (cut.entry && vibration.start_s > cut.begin_s - before_s &&
        vibration.end_s < cut.begin_s + within_s) {
      return CutPlace::entry;
    }
    if (cut.exit && vibration.start_s > cut.end_s - within_s &&
        vibration.end_s < cut.end_s + within_s) {
      return CutPlace::exit;
    }
    within = within || (vibration.start_s > cut.begin_s - before_s &&
                        vibration.start_s < cut.end_s + before_s);
    loudest = std::max(loudest, cut.energy);
  }
  return within || vibration.energy > kLoudShare * loudest ? CutPlace::cut : CutPlace::air;
}

}  // namespace steadyrest::chatter::offline
