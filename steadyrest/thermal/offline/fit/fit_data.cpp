// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <cmath>
#include <limits>
#include <span>

#include <steadyrest/kernel/units/convert.hpp>
#include <steadyrest/thermal/offline/fit/error_model.hpp>
#include <steadyrest/thermal/offline/fit/fit_data.hpp>
#include <steadyrest/thermal/offline/plan/forecast.hpp>

// Readings are thinned, inputs are not: a column walks every row of the log and is then sampled at
// the chosen rows. Thinning costs little, since successive readings carry the same drift.
namespace steadyrest::thermal::offline {
namespace {

constexpr double kLeastNoise_um = 0.01;  // a logger's last digit
constexpr double kLeastBlock_s = 2.0 * 3600.0;
constexpr double kLeastOwn_s = 30.0 * 60.0;  // a shorter one is no separate block
constexpr std::size_t kEqualBlocks = 5;
constexpr double kSame_um = 1e-6;

/// Rows of the log at which the spindle starts after a rest.
std::vector<std::size_t> starts(const Log& log) {
  std::vector<std::size_t> out;
  double stopped_s = -std::numeric_limits<double>::infinity();
  for (std::size_t i = 0; i < log.rows(); ++i) {
    const bool turns = log.speed_rev_s[i] > 0.0;
    if (turns && (i == 0 || log.speed_rev_s[i - 1] == 0.0) &&
        log.time_s[i] - stopped_s >= kRest_s) {
      out.push_back(i);
    }
    if (!turns && i > 0 && log.speed_rev_s[i - 1] > 0.0) {
      stopped_s = log.time_s[i];
    }
  }
  return out;
}

/// The smallest step between readings: the gauge's resolution.
double last_digit_um(const std::vector<double>& reading_um) {
  double least = std::numeric_limits<double>::infinity();
  for (std::size_t i = 1; i < reading_um.size(); ++i) {
    const double step = std::abs(reading_um[i] - reading_um[i - 1]);
    least = step > kSame_um && step < least ? step : least;  // a hole is no step
  }
  return std::isfinite(least) ? least : 0.0;
}

// Borders are times, since readings are thinned and the row of a start may be missing.
void cut(FitData& data, const std::vector<double>& border_s) {
  std::size_t begin = 0;
  for (std::size_t b = 0; b <= border_s.size(); ++b) {
    const auto end =
        b == border_s.size()
            ? data.rows()
            : static_cast<std::size_t>(std::ranges::lower_bound(data.time_s, border_s[b]) -
                                       data.time_s.begin());
    if (end > begin) {
      data.block.push_back({begin, end});
      begin = end;
    }
  }
}

// A block begins where the spindle starts after a rest of kRest_s and lasts to the next such start,
// so each contains one warm-up and the cooling after it. Starts that would leave a stub of less
// than half an hour before or after them are no border.
void cut_into_blocks(FitData& data) {
  std::vector<double> border_s;
  for (const std::size_t row : starts(*data.log)) {
    const double t = data.log->time_s[row];
    const double before_s = border_s.empty() ? data.time_s.front() : border_s.back();
    if (t > data.time_s.front() && t - before_s >= (border_s.empty() ? 0.0 : kLeastOwn_s) &&
        data.time_s.back() - t >= kLeastOwn_s) {
      border_s.push_back(t);
    }
  }
  if (!border_s.empty()) {
    border_s.erase(border_s.begin());  // the time before the first start belongs to it
  }
  // A spindle with only one or two starts gives no runs to leave out: pieces of equal time then.
  if (border_s.size() + 1 < kLeastBlocks) {
    border_s.clear();
    const double span_s = data.time_s.back() - data.time_s.front();
    const auto pieces = std::min(kEqualBlocks, static_cast<std::size_t>(span_s / kLeastBlock_s));
    for (std::size_t b = 1; b < pieces; ++b) {
      border_s.push_back(data.time_s.front() +
                         span_s * static_cast<double>(b) / static_cast<double>(pieces));
    }
  }
  if (border_s.size() + 1 >= kLeastBlocks) {
    cut(data, border_s);
  }
}

}  // namespace

std::vector<std::size_t> FitData::within_reach() const {
  std::vector<double> fastest;
  for (const Block& b : block) {
    const auto from = log->speed_rev_s.begin();
    fastest.push_back(*std::max_element(from + static_cast<std::ptrdiff_t>(row[b.begin]),
                                        from + static_cast<std::ptrdiff_t>(row[b.end - 1]) + 1));
  }
  std::vector<std::size_t> out;
  std::vector<std::size_t> all;
  for (std::size_t b = 0; b < block.size(); ++b) {
    double others = 0.0;
    for (std::size_t o = 0; o < block.size(); ++o) {
      others = o == b ? others : std::max(others, fastest[o]);
    }
    // Left out, the fastest block would need an extrapolation that no user is given.
    if (fastest[b] <= kBeyondFitted * others) {
      out.push_back(b);
    }
    all.push_back(b);
  }
  return out.size() < 2 ? all : out;
}

FitData fit_data(const Log& log, std::size_t channel, double from_s, double to_s) {
  FitData data;
  data.log = &log;
  data.channel = channel;
  const std::vector<double>& value = log.displacement[channel].value;
  const double span_s = std::min(to_s, log.time_s.back()) - std::max(from_s, log.time_s.front());
  const double step_s = std::max(span_s / static_cast<double>(kFitRows), 0.0);
  std::vector<double> read_um;
  double next_s = -std::numeric_limits<double>::infinity();
  std::size_t last = log.rows();
  auto gap = log.gap.begin();
  bool fresh = false;
  const auto take = [&](std::size_t i) {
    if (fresh && !data.row.empty()) {
      data.fresh.push_back(data.row.size());
    }
    fresh = false;
    data.row.push_back(i);
    data.time_s.push_back(log.time_s[i]);
    read_um.push_back(kernel::units::um_from_mm(value[i]));
  };
  for (std::size_t i = 0; i < log.rows(); ++i) {
    if (gap != log.gap.end() && *gap == i) {
      fresh = true;
      ++gap;
    }
    const double t = log.time_s[i];
    if (t < from_s || t > to_s || !std::isfinite(value[i])) {
      continue;
    }
    last = i;
    if (t >= next_s) {
      take(i);
      // On the grid of steps as long as rows keep up; after a hole the grid restarts at the row.
      next_s = std::max(next_s, t - step_s) + step_s;
      next_s = next_s <= t ? t + step_s : next_s;
    }
  }
  // The last reading always counts: a forecast begins there.
  if (last < log.rows() && (data.row.empty() || data.row.back() != last)) {
    take(last);
  }
  data.reading_um =
      Eigen::Map<const Eigen::VectorXd>(read_um.data(), static_cast<Eigen::Index>(read_um.size()));
  if (!data.row.empty()) {
    data.zero_um = data.reading_um(0);
    data.reading_um.array() -= data.zero_um;
    const std::size_t begin = data.row.front();
    const std::size_t count = data.row.back() + 1 - begin;
    data.fastest_rev_s = std::ranges::max(std::span(log.speed_rev_s).subspan(begin, count));
    std::vector<double> all_um(count);
    std::ranges::transform(std::span(value).subspan(begin, count), all_um.begin(),
                           kernel::units::um_from_mm);
    // A gauge rounds evenly to its last digit q: standard deviation q/√12.
    data.noise_um = std::max({noise_of(std::span(log.time_s).subspan(begin, count), all_um),
                              last_digit_um(all_um) / std::sqrt(12.0), kLeastNoise_um});
    cut_into_blocks(data);
  }
  return data;
}

double longest_run_s(const Log& log, double from_s, double to_s) {
  double longest = 0.0;
  double start_s = 0.0;
  bool running = false;
  for (std::size_t i = 1; i < log.rows(); ++i) {
    const bool inside = log.time_s[i - 1] >= from_s && log.time_s[i] <= to_s;
    const double before = log.speed_rev_s[i - 1];
    // Within 1 % counts as one speed: actual speeds waver.
    const bool same =
        running && std::abs(before - log.speed_rev_s[i > 1 ? i - 2 : 0]) <= 0.01 * before;
    if (!inside || before == 0.0) {
      running = false;
      continue;
    }
    if (!same) {
      start_s = log.time_s[i - 1];
      running = true;
    }
    longest = std::max(longest, log.time_s[i] - start_s);
  }
  return longest;
}

}  // namespace steadyrest::thermal::offline
