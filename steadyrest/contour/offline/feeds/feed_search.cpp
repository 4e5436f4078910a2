// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <cmath>
#include <utility>

#include <steadyrest/contour/offline/feeds/feed_search.hpp>
#include <steadyrest/contour/offline/feeds/rapid_lag.hpp>

namespace steadyrest::contour::offline {
namespace {

/// An error within this share above the limit counts as within it.
constexpr double kSame = 0.002;
/// A cell slower than this share of its feed is limited by something else.
constexpr double kBinds = 0.97;
/// How far below a speed that was too fast the ceiling falls, in powers of what v ← v·√(limit/ε)
/// asks for.
constexpr double kCeilingShare = 0.5;

}  // namespace

FeedSearch::FeedSearch(const kernel::machine::Machine& machine, FeedCells& cells,
                       const nc::plan::PlannedPath& original, const ServoModels& models,
                       const Config& config)
    : machine_(machine),
      cells_(cells),
      original_(original),
      models_(models),
      config_(config),
      run_(cells.path.segments.size()),
      limit_mm_(run_.size(), static_cast<float>(config.limit_mm)),
      worst_(run_.size(), 0.0F),
      group_(run_.size()),
      ratio_(run_.size(), 1.0),
      ceiling_ratio_(run_.size(), 1.0) {
  for (std::size_t i = 0; i < group_.size(); ++i) {
    const bool joined = cells.kind[i] == FeedKind::joined && i > 0;
    group_[i] = joined ? group_[i - 1] : static_cast<std::uint32_t>(i);
  }
}

void FeedSearch::set_groups(std::vector<std::uint32_t> group) {
  group_ = std::move(group);
  std::fill(ceiling_ratio_.begin(), ceiling_ratio_.end(), 1.0);
}

void FeedSearch::set_limit(std::size_t segment, double limit_mm) {
  const auto [first, end] =
      std::ranges::equal_range(cells_.of, static_cast<std::uint32_t>(segment));
  const auto from = static_cast<std::size_t>(first - cells_.of.begin());
  std::fill_n(limit_mm_.begin() + static_cast<std::ptrdiff_t>(from), end - first,
              static_cast<float>(limit_mm));
}

void FeedSearch::set_ratios(std::vector<double> ratio) {
  ratio_ = std::move(ratio);
  for (std::size_t i = 0; i < ratio_.size(); ++i) {
    cells_.path.plans[i].feed_mm_s = cells_.ceiling[i] * ratio_[i];
  }
}

kernel::outcome::Result<double> FeedSearch::measure() {
  std::fill(run_.begin(), run_.end(), CellRun{});
  RapidLag rapid(softest_gain_1_s(models_));
  double before_s = 0.0;
  const auto add = [&](const ModelSample& sample) {
    CellRun& cell = run_[sample.segment];
    const auto passed_s = sample.ended ? 0.0F : static_cast<float>(sample.time_s - before_s);
    cell.seconds += passed_s;
    cell.waiting_s += sample.command_mm_s > 0.0 ? 0.0F : passed_s;
    before_s = sample.time_s;
    cell.speed_mm_s = std::max(cell.speed_mm_s, static_cast<float>(sample.command_mm_s));
    const bool feed = cells_.path.segments[sample.segment].motion == kernel::signal::Motion::feed;
    const double of_feed = rapid.of_feed_mm(sample, feed);
    if (sample.cuts) {
      cell.error_mm = std::max(cell.error_mm, static_cast<float>(std::abs(sample.error_mm)));
      cell.of_feed_mm = std::max(cell.of_feed_mm, static_cast<float>(of_feed));
    }
  };
  const auto seconds = run_model({machine_, cells_.path, original_, cells_.map, models_, {}}, add);
  if (!seconds) {
    return seconds;
  }
  // Passed between two samples: like the cell before.
  for (std::size_t i = 1; i < run_.size(); ++i) {
    if (run_[i].seconds == 0.0F && run_[i - 1].speed_mm_s > 0.0F) {
      run_[i].speed_mm_s = run_[i - 1].speed_mm_s;
      run_[i].seconds = static_cast<float>(cells_.path.segments[i].length_mm) / run_[i].speed_mm_s;
    }
  }
  look_ahead();
  return seconds;
}

/// The largest ε/limit within the reach behind each cell: a window that slides backwards in time.
void FeedSearch::look_ahead() {
  const double reach_s = kReach / softest_gain_1_s(models_);
  std::vector<std::size_t> falling;  // cells of falling ε/limit; the nearest is the last
  std::size_t farthest = 0;          // of them: those before are out of reach
  std::vector<double> leaves_s(run_.size() + 1, 0.0);
  for (std::size_t i = 0; i < run_.size(); ++i) {
    leaves_s[i + 1] = leaves_s[i] + static_cast<double>(run_[i].seconds);
  }
  const auto over = [&](std::size_t i) { return run_[i].of_feed_mm / limit_mm_[i]; };
  for (std::size_t i = run_.size(); i-- > 0;) {
    while (falling.size() > farthest && over(falling.back()) <= over(i)) {
      falling.pop_back();
    }
    falling.push_back(i);
    farthest = std::min(farthest, falling.size() - 1);
    // Reached when the command enters it within the reach after it has left cell i.
    while (leaves_s[falling[farthest]] > leaves_s[i + 1] + reach_s) {
      ++farthest;
    }
    worst_[i] = over(falling[farthest]);
  }
}

/// Of its feed; of a feed per revolution it is not known, so all of it.
double FeedSearch::used_share(std::size_t cell) const noexcept {
  const nc::plan::SegmentPlan& plan = cells_.path.plans[cell];
  return plan.per_revolution ? 1.0 : static_cast<double>(run_[cell].speed_mm_s) / plan.feed_mm_s;
}

void FeedSearch::choose(std::size_t first, std::size_t end, bool settle) {
  double wish = 1e9;
  bool over = false;
  for (std::size_t i = first; i < end; ++i) {
    const double speed = run_[i].speed_mm_s;
    const auto worst = static_cast<double>(worst_[i]);
    const double used = used_share(i);
    const bool binds = end == first + 1 || used >= kBinds;
    if (speed > 0.0 && (binds || worst > 1.0 + kSame)) {
      wish = std::min(wish, ratio_[i] * used / std::sqrt(std::max(worst, 0.01)));
      over = over || worst > 1.0 + kSame;
    }
  }
  double ratio = std::clamp(wish, config_.floor_ratio, 1.0);
  if (settle && over && ratio < ratio_[first]) {
    const double most = ratio_[first] * std::pow(ratio / ratio_[first], kCeilingShare);
    std::fill_n(ceiling_ratio_.begin() + static_cast<std::ptrdiff_t>(first), end - first,
                std::min(most, ceiling_ratio_[first]));
  }
  ratio = std::min(ratio, std::max(ceiling_ratio_[first], config_.floor_ratio));
  for (std::size_t i = first; i < end; ++i) {
    ratio_[i] = ratio;
    cells_.path.plans[i].feed_mm_s = cells_.ceiling[i] * ratio;
  }
}

void FeedSearch::adjust(bool settle) {
  for (std::size_t first = 0; first < run_.size();) {
    std::size_t end = first + 1;
    while (end < run_.size() && group_[end] == group_[first]) {
      ++end;
    }
    if (cells_.kind[first] != FeedKind::fixed) {
      choose(first, end, settle);
    }
    first = end;
  }
}

bool FeedSearch::keeps_limit() const noexcept {
  for (std::size_t i = 0; i < run_.size(); ++i) {
    if (static_cast<double>(worst_[i]) > 1.0 + 2.0 * kSame && cells_.kind[i] != FeedKind::fixed &&
        ratio_[i] > config_.floor_ratio * (1.0 + 1e-9)) {
      return false;
    }
  }
  return true;
}

}  // namespace steadyrest::contour::offline
