// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <cmath>

#include <fmt/core.h>

#include <steadyrest/contour/offline/feeds/feed_groups.hpp>
#include <steadyrest/contour/offline/feeds/feed_plan.hpp>
#include <steadyrest/contour/offline/feeds/feed_search.hpp>
#include <steadyrest/kernel/outcome/bad_input.hpp>

namespace steadyrest::contour::offline {
namespace {

using kernel::outcome::refuse;
using kernel::outcome::Result;

constexpr int kCellRuns = 4;
constexpr int kGroupRuns = 6;
/// From feeds that nearly fit.
constexpr int kNearRuns = 3;
/// The search's interpolator period, in 1/k.
constexpr double kPeriodOfLag = 0.05;
/// The shortest part of a segment that becomes a separate block, in interpolator periods.
constexpr double kShortestPeriods = 3.0;

/// Cells are more blocks than the program will have: the look-ahead reaches as far along the path.
/// A period far below 1/k would only cost time.
kernel::machine::Machine searched(kernel::machine::Machine machine, const ServoModels& models,
                                  std::size_t segments, std::size_t cells) {
  kernel::machine::Control& control = machine.control;
  const std::size_t times = (cells + segments - 1) / std::max<std::size_t>(1, segments);
  control.look_ahead_blocks = static_cast<std::uint32_t>(
      std::min<std::size_t>(control.look_ahead_blocks * times, 1U << 16U));
  const double periods = kPeriodOfLag / softest_gain_1_s(models) / control.interpolator_period_s;
  control.interpolator_period_s *= std::max(1.0, std::floor(periods));
  return machine;
}

}  // namespace

struct FeedPlan::Parts {
  explicit Parts(const FeedTask& task)
      : cells(feed_cells(task.path, task.map, task.room)),
        machine(searched(task.machine, task.model, task.path.segments.size(), cells.of.size())),
        search(machine, cells, task.original, task.model,
               {.limit_mm = task.limit_mm, .floor_ratio = task.floor_ratio}),
        few{.most_loss_s = 0.0,
            .shortest_s = kShortestPeriods * task.machine.control.interpolator_period_s},
        loss_share(task.loss_share),
        progress(task.progress) {}

  /// One run.
  Result<double> measure() {
    constexpr double kMostRuns = kCellRuns + kGroupRuns;
    progress(std::min(1.0, runs++ / kMostRuns));
    return search.measure();
  }

  FeedCells cells;
  kernel::machine::Machine machine;
  FeedSearch search;
  FewFeeds few;
  double loss_share;
  std::function<void(double share)> progress;
  int runs = 0;
};

FeedPlan::FeedPlan() = default;
FeedPlan::FeedPlan(FeedPlan&&) noexcept = default;
FeedPlan::~FeedPlan() = default;

Result<FeedPlan> FeedPlan::make(const FeedTask& task) {
  if (!(task.limit_mm > 0.0) || !std::isfinite(task.limit_mm)) {
    return refuse(fmt::format("the limit of the contour error is {} mm", task.limit_mm),
                  "give one above 0");
  }
  if (!(task.floor_ratio > 0.0 && task.floor_ratio <= 1.0)) {
    return refuse(fmt::format("the lowest feed is {} of the programmed one", task.floor_ratio),
                  "give a share above 0, at most 1");
  }
  FeedPlan plan;
  plan.of_ = std::make_unique<Parts>(task);
  FeedSearch& search = plan.of_->search;
  if (!task.start.empty()) {
    std::vector<double> ratio;
    for (const std::uint32_t segment : plan.of_->cells.of) {
      ratio.push_back(std::clamp(task.start[segment], task.floor_ratio, 1.0));
    }
    search.set_ratios(std::move(ratio));
  }
  auto seconds = plan.of_->measure();
  if (!seconds) {
    return std::unexpected(seconds.error());
  }
  plan.seconds_before_ = plan.seconds_ = *seconds;
  plan.unchanged_ = task.start.empty() && search.keeps_limit();
  if (plan.unchanged_) {
    return plan;
  }
  for (int i = 1; i < (task.start.empty() ? kCellRuns : kNearRuns); ++i) {
    search.adjust(i > 1);
    seconds = plan.of_->measure();
    if (!seconds) {
      return std::unexpected(seconds.error());
    }
  }
  plan.of_->few.most_loss_s = plan.of_->loss_share * *seconds;
  std::vector<double> ratio = search.ratio();
  search.set_groups(group_feeds(plan.of_->cells, search, plan.of_->few, ratio));
  search.set_ratios(std::move(ratio));
  if (const auto done = plan.search(task.rough           ? 1
                                    : task.start.empty() ? kGroupRuns
                                                         : kNearRuns);
      !done) {
    return std::unexpected(done.error());
  }
  return plan;
}

Result<void> FeedPlan::search(int rounds) {
  FeedSearch& search = of_->search;
  for (int i = 0; i < rounds; ++i) {
    const auto seconds = of_->measure();
    if (!seconds) {
      return std::unexpected(seconds.error());
    }
    seconds_ = *seconds;
    // The first runs may still find room to go faster.
    if (i >= 2 && search.keeps_limit()) {
      return {};
    }
    search.adjust(true);
  }
  return {};
}

Result<void> FeedPlan::tighten(const std::vector<std::pair<std::size_t, double>>& limit_mm) {
  for (const auto& [segment, limit] : limit_mm) {
    of_->search.set_limit(segment, limit);
  }
  unchanged_ = false;
  of_->progress = [](double) {};  // of make() alone
  return search(kNearRuns);
}

std::vector<FeedPart> FeedPlan::parts() const {
  std::vector<FeedPart> out;
  const FeedCells& cells = of_->cells;
  const std::vector<double>& ratio = of_->search.ratio();
  for (std::size_t i = 0; i < cells.of.size(); ++i) {
    const double to = cells.from_mm[i] + cells.path.segments[i].length_mm;
    if (cells.kind[i] == FeedKind::fixed) {
      continue;
    }
    if (!out.empty() && out.back().segment == cells.of[i] && out.back().ratio == ratio[i]) {
      out.back().to_mm = to;
    } else {
      out.push_back({cells.of[i], cells.from_mm[i], to, ratio[i]});
    }
  }
  return out;
}

}  // namespace steadyrest::contour::offline
