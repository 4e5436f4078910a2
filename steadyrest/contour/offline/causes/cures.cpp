// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <optional>
#include <utility>

#include <fmt/core.h>

#include <steadyrest/contour/offline/causes/places.hpp>
#include <steadyrest/kernel/units/convert.hpp>
#include <steadyrest/math/geometry/path_pairing.hpp>
#include <steadyrest/nc/rewrite/replace/block_text.hpp>

namespace steadyrest::contour::offline {
namespace {

using kernel::outcome::Result;
using kernel::signal::Motion;
using nc::plan::PathEvent;
using nc::plan::PathEventKind;
using nc::plan::PlannedPath;

constexpr std::size_t kMostSegments = 600;  ///< of a window, on each side of its place
constexpr int kStopsBefore = 3;             ///< where a window begins
constexpr std::array kDwells = {1.0, 2.0, 3.0, 4.0, 6.0, 8.0};  ///< in 1/k
constexpr int kFeedSteps = 8;
constexpr double kAim = 0.95;
constexpr double kLeastCure = 0.25;  ///< of the programmed one
constexpr double kFeedStep_mm_min = 10.0;
constexpr double kNear_mm = 0.02;

/// Part of the path that is run, from a stop to a stop.
struct Window {
  PlannedPath path;
  PathMap map;
  std::size_t first = 0;  ///< its first segment, on the whole path
};

bool stops_after(const PlannedPath& path, std::size_t i) noexcept {
  return path.plans[i].exit_speed_limit_mm_s <= 0.0;
}

Window window_round(const OverTask& task, std::size_t segment) {
  const PlannedPath& path = task.path;
  std::size_t first = segment;
  int stops = 0;
  while (first > 0 && segment - first < kMostSegments) {
    stops += stops_after(path, first - 1) ? 1 : 0;
    if (stops >= kStopsBefore) {
      break;
    }
    --first;
  }
  std::size_t last = segment;
  bool ends = false;  // one stop is the place's own
  while (last + 1 < path.segments.size() && last - segment < kMostSegments) {
    if (stops_after(path, last) && std::exchange(ends, true)) {
      break;
    }
    ++last;
  }
  Window out{.path = {}, .map = {}, .first = first};
  const auto slice = [&](const auto& of) {
    return std::decay_t<decltype(of)>(of.begin() + static_cast<std::ptrdiff_t>(first),
                                      of.begin() + static_cast<std::ptrdiff_t>(last + 1));
  };
  out.path.segments = slice(path.segments);
  out.path.plans = slice(path.plans);
  out.map.start_mm = slice(task.map.start_mm);
  out.map.end_mm = slice(task.map.end_mm);
  const double start_mm = out.path.segments.front().position_mm;
  for (auto& one : out.path.segments) {
    one.position_mm -= start_mm;
  }
  for (const PathEvent& event : path.events) {
    if (event.kind == PathEventKind::dwell && event.segment >= first && event.segment <= last) {
      out.path.events.push_back(event);
      out.path.events.back().segment -= first;
    }
  }
  return out;
}

/// What a window takes and leaves at its place.
struct Tried {
  double seconds = 0.0;
  double error_mm = 0.0;
};

/// Tries changes of the path in a window round one place.
class Trial {
 public:
  Trial(const OverTask& task, const Peak& peak)
      : task_(task), peak_(peak), window_(window_round(task, peak.segment)) {
    const double lead = std::abs(peak.progress_mm - peak.foot_mm);
    from_mm_ = std::min(peak.foot_mm, peak.progress_mm) - lead - kNear_mm;
    to_mm_ = std::max(peak.foot_mm, peak.progress_mm) + lead + kNear_mm;
  }

  Result<Tried> run(const PlannedPath& path) const {
    Tried out;
    const auto seconds = run_model(
        {.machine = task_.machine,
         .path = path,
         .original = task_.original,
         .map = window_.map,
         .model = servo_models(task_.machine.axes),
         .others = {},
         .backlash_mm = backlash_mm(task_.machine.axes),
         .unknown = task_.unknown},
        [&](const ModelSample& sample) {
          if (sample.cuts && sample.foot_mm >= from_mm_ && sample.foot_mm <= to_mm_) {
            out.error_mm = std::max(out.error_mm, std::abs(sample.error_mm) + sample.more_mm);
          }
        });
    if (!seconds) {
      return std::unexpected(seconds.error());
    }
    out.seconds = *seconds;
    return out;
  }
  Result<void> begin() {
    const auto now = run(window_.path);
    if (!now) {
      return std::unexpected(now.error());
    }
    now_ = *now;
    return {};
  }

  /// A dwell before this segment of the window; none where no dwell helps.
  Result<std::optional<Cure>> dwell(std::size_t before) const;
  /// A lower feed on the lines of the place.
  Result<std::optional<Cure>> feed() const;

  /// The window's segment that begins nearest to a place of the original, or none.
  [[nodiscard]] std::optional<std::size_t> segment_at(double original_mm) const {
    std::optional<std::size_t> nearest;
    double least_mm = kNear_mm;
    for (std::size_t i = 1; i < window_.map.start_mm.size(); ++i) {
      const double off_mm = std::abs(window_.map.start_mm[i] - original_mm);
      if (off_mm < least_mm && window_.path.segments[i].motion == Motion::feed &&
          window_.path.segments[i - 1].motion == Motion::feed) {
        least_mm = off_mm;
        nearest = i;
      }
    }
    return nearest;
  }
  /// Its feeds are the spindle's, which a window does not turn.
  [[nodiscard]] bool waits_for_spindle() const {
    return std::ranges::any_of(window_.path.plans, &nc::plan::SegmentPlan::per_revolution);
  }
  /// The first segment that cuts behind the last rapid before the place; none where both are of one
  /// block, a drilling cycle's: no dwell goes between them.
  [[nodiscard]] std::optional<std::size_t> after_rapid() const {
    const auto& segments = window_.path.segments;
    for (std::size_t i = peak_.segment - window_.first; i > 0; --i) {
      if (segments[i].motion == Motion::feed && segments[i - 1].motion == Motion::rapid) {
        return segments[i].line == segments[i - 1].line ? std::nullopt : std::optional(i);
      }
    }
    return std::nullopt;
  }

 private:
  const OverTask& task_;
  const Peak& peak_;
  Window window_;
  double from_mm_ = 0.0;
  double to_mm_ = 0.0;
  Tried now_;
};

Result<std::optional<Cure>> Trial::dwell(std::size_t before) const {
  const double gain_1_s = softest_gain_1_s(servo_models(task_.machine.axes));
  const std::uint32_t line = task_.origin(window_.path.segments[before].line);
  std::optional<Cure> best;
  for (const double lags : kDwells) {
    const double dwell_s = std::ceil(100.0 * lags / gain_1_s) / 100.0;
    PlannedPath path = window_.path;
    path.plans[before - 1].exit_speed_limit_mm_s = 0.0;
    path.segments[before - 1].exit_speed_limit_mm_s = 0.0;
    const auto place = std::ranges::upper_bound(path.events, before, {}, &PathEvent::segment);
    path.events.insert(place, {.kind = PathEventKind::dwell,
                               .segment = before,
                               .line = window_.path.segments[before].line,
                               .value = dwell_s});
    const auto tried = run(path);
    if (!tried) {
      return std::unexpected(tried.error());
    }
    if (best && tried->error_mm > kAim * best->leaves_mm) {
      continue;  // a longer dwell must win something
    }
    best = Cure{
        .what = fmt::format("{} before line {}",
                            nc::rewrite::dwell_text(task_.machine.control.dialect, dwell_s), line),
        .seconds = tried->seconds - now_.seconds,
        .leaves_mm = tried->error_mm};
    if (best->holds(task_.limit_mm)) {
      break;
    }
  }
  return best && best->leaves_mm < kAim * now_.error_mm ? best : std::nullopt;
}

Result<std::optional<Cure>> Trial::feed() const {
  PlannedPath path = window_.path;
  std::vector<std::size_t> slower;
  double feed_mm_s = 0.0;
  std::uint32_t first = std::numeric_limits<std::uint32_t>::max();
  std::uint32_t last = 0;
  const auto& segments = path.segments;
  for (std::size_t i = 0; i < segments.size(); ++i) {
    const bool there = window_.map.end_mm[i] > from_mm_ && window_.map.start_mm[i] < to_mm_;
    if (there && segments[i].motion == Motion::feed) {
      const std::uint32_t line = task_.origin(segments[i].line);
      first = std::min(first, line);
      last = std::max(last, line);
    }
  }
  for (std::size_t i = 0; i < segments.size(); ++i) {
    const std::uint32_t line = task_.origin(segments[i].line);
    if (line >= first && line <= last && segments[i].motion == Motion::feed) {
      slower.push_back(i);
      feed_mm_s = std::max(feed_mm_s, path.plans[i].feed_mm_s);
    }
  }
  const double least_mm_s = std::max(kLeastCure, task_.machine.contour.min_ratio) * feed_mm_s;
  double error_mm = now_.error_mm;
  double aim_mm_s = std::min(feed_mm_s, std::max(peak_.speed_mm_s, 0.3 * feed_mm_s));
  std::optional<Cure> best;
  for (int step = 0; step < kFeedSteps && !slower.empty() && aim_mm_s > least_mm_s; ++step) {
    aim_mm_s = std::max(least_mm_s, aim_mm_s * std::sqrt(kAim * task_.limit_mm / error_mm));
    const double mm_min = std::max(
        kFeedStep_mm_min, kFeedStep_mm_min * std::floor(kernel::units::mm_min_from_mm_s(aim_mm_s) /
                                                        kFeedStep_mm_min));
    for (const std::size_t i : slower) {
      const double to =
          std::min(window_.path.plans[i].feed_mm_s, kernel::units::mm_s_from_mm_min(mm_min));
      path.plans[i].feed_mm_s = to;
      path.segments[i].feed_mm_s = to;
    }
    const auto tried = run(path);
    if (!tried) {
      return std::unexpected(tried.error());
    }
    error_mm = tried->error_mm;
    if (!best || error_mm < best->leaves_mm) {
      best =
          Cure{.what = first == last ? fmt::format("F{:.0f} on line {}", mm_min, first)
                                     : fmt::format("F{:.0f} on lines {}-{}", mm_min, first, last),
               .seconds = tried->seconds - now_.seconds,
               .leaves_mm = error_mm};
    }
    if (error_mm <= task_.limit_mm) {
      break;
    }
  }
  return best && best->leaves_mm < kAim * now_.error_mm ? best : std::nullopt;
}

}  // namespace

Result<std::vector<Cure>> cures_of(const OverTask& task, const Peak& peak) {
  Trial trial(task, peak);
  if (trial.waits_for_spindle()) {
    return std::vector<Cure>{};
  }
  if (auto begun = trial.begin(); !begun) {
    return std::unexpected(begun.error());
  }
  std::vector<Cure> out;
  Result<void> fault;
  const auto add = [&](const Result<std::optional<Cure>>& cure) {
    if (!cure) {
      fault = std::unexpected(cure.error());
    } else if (*cure) {
      out.push_back(**cure);
    }
  };
  const auto corner = corner_at(task, peak);
  if (by_rapid(task, peak)) {
    if (const auto before = trial.after_rapid()) {
      add(trial.dwell(*before));
    }
  } else {
    if (const auto before = corner ? trial.segment_at(corner->at_mm) : std::nullopt) {
      add(trial.dwell(*before));
    }
    add(trial.feed());
  }
  if (!fault) {
    return std::unexpected(fault.error());
  }
  sort_cures(out, task.limit_mm);
  return out;
}

void sort_cures(std::vector<Cure>& cures, double limit_mm) {
  std::ranges::stable_sort(cures, {}, [&](const Cure& cure) {
    return cure.holds(limit_mm) ? std::pair(0, cure.seconds) : std::pair(1, cure.leaves_mm);
  });
}

}  // namespace steadyrest::contour::offline
