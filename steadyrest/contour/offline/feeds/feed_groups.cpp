// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <cstddef>
#include <limits>
#include <queue>

#include <steadyrest/contour/offline/feeds/feed_groups.hpp>

namespace steadyrest::contour::offline {
namespace {

constexpr double kNoUnion = std::numeric_limits<double>::infinity();
constexpr std::size_t kNoRun = std::numeric_limits<std::size_t>::max();

/// Neighbouring cells with one feed. A run is named by its first cell.
struct Run {
  std::size_t end = 0;
  std::size_t before = kNoRun;
  double ratio = 1.0;
  double seconds = 0.0;
  std::uint32_t version = 0;
};

/// The union of a run and the one behind it.
struct Union {
  double cost_s = 0.0;
  std::size_t first = 0;
  std::uint32_t version = 0;
  std::uint32_t next_version = 0;
  bool operator>(const Union& other) const noexcept { return cost_s > other.cost_s; }
};

class Grouping {
 public:
  Grouping(const FeedCells& cells, const FeedSearch& search, const FewFeeds& few,
           const std::vector<double>& ratio)
      : cells_(cells), search_(search), few_(few), run_(cells.of.size()) {
    std::size_t before = kNoRun;
    for (std::size_t i = 0; i < run_.size();) {
      Run& run = run_[i];
      run = {.end = i, .before = before, .ratio = ratio[i]};
      do {
        run.ratio = std::min(run.ratio, ratio[run.end]);
        run.seconds += moving_s(run.end);
        ++run.end;
      } while (run.end < run_.size() && search.group()[run.end] == search.group()[i]);
      before = i;
      i = run.end;
    }
    for (std::size_t i = 0; i < run_.size(); i = run_[i].end) {
      offer(i);
    }
  }

  void unite() {
    while (!queue_.empty()) {
      const Union best = queue_.top();
      queue_.pop();
      const std::size_t next = run_[best.first].end;
      if (next >= run_.size() || next == best.first || run_[best.first].version != best.version ||
          run_[next].version != best.next_version) {
        continue;  // one of them has grown since
      }
      if (best.cost_s >= 0.0) {
        loss_s_ += best.cost_s;
        if (loss_s_ > few_.most_loss_s) {
          break;
        }
      }
      join(best.first, next);
    }
  }

  std::vector<std::uint32_t> take(std::vector<double>& ratio) const {
    std::vector<std::uint32_t> group(run_.size());
    std::uint32_t number = 0;
    for (std::size_t i = 0; i < run_.size(); i = run_[i].end) {
      std::fill(group.begin() + static_cast<std::ptrdiff_t>(i),
                group.begin() + static_cast<std::ptrdiff_t>(run_[i].end), number++);
      std::fill(ratio.begin() + static_cast<std::ptrdiff_t>(i),
                ratio.begin() + static_cast<std::ptrdiff_t>(run_[i].end), run_[i].ratio);
    }
    return group;
  }

 private:
  /// Begins inside a segment.
  [[nodiscard]] bool inside(std::size_t cell) const noexcept {
    return cell < cells_.of.size() && cells_.from_mm[cell] > 0.0;
  }
  /// A part of a segment that is too short for a block.
  [[nodiscard]] bool too_short(std::size_t first) const noexcept {
    const Run& run = run_[first];
    return run.seconds < few_.shortest_s && (inside(first) || inside(run.end));
  }
  [[nodiscard]] bool fits(std::size_t a, std::size_t b) const noexcept {
    return cells_.kind[a] != FeedKind::fixed && cells_.kind[b] != FeedKind::fixed &&
           cells_.ceiling[a] == cells_.ceiling[b] &&
           cells_.path.plans[a].per_revolution == cells_.path.plans[b].per_revolution;
  }
  /// A dwell takes as long at any feed.
  [[nodiscard]] double moving_s(std::size_t cell) const noexcept {
    const CellRun& run = search_.runs()[cell];
    return static_cast<double>(run.seconds - run.waiting_s);
  }
  /// What a run costs at a lower feed than its own.
  [[nodiscard]] double loss_s(std::size_t first, double ratio) const noexcept {
    const Run& run = run_[first];
    double loss = 0.0;
    if (ratio >= run.ratio) {
      return loss;
    }
    for (std::size_t i = first; i < run.end; ++i) {
      // It was run at `reached`, and takes longer now if it has been united since.
      const double reached = search_.ratio()[i] * std::min(1.0, search_.used_share(i));
      const double now = std::max(1.0, reached / run.ratio);
      loss += moving_s(i) * std::max(0.0, reached / ratio - now);
      if (loss > few_.most_loss_s) {
        return kNoUnion;
      }
    }
    return loss;
  }
  void offer(std::size_t first) {
    const std::size_t next = run_[first].end;
    if (next >= run_.size() || !fits(first, next)) {
      return;
    }
    const double ratio = std::min(run_[first].ratio, run_[next].ratio);
    double cost = loss_s(first, ratio) + loss_s(next, ratio);
    // Into the neighbour that costs less: both offers are below 0, the cheaper comes first.
    if (inside(next) && (too_short(first) || too_short(next))) {
      cost = std::min(cost, few_.most_loss_s) - 1e6;
    }
    if (cost < kNoUnion) {
      queue_.push({cost, first, run_[first].version, run_[next].version});
    }
  }
  void join(std::size_t first, std::size_t next) {
    Run& run = run_[first];
    run.ratio = std::min(run.ratio, run_[next].ratio);
    run.seconds += run_[next].seconds;
    run.end = run_[next].end;
    ++run.version;
    ++run_[next].version;
    if (run.end < run_.size()) {
      run_[run.end].before = first;
    }
    offer(first);
    if (run.before != kNoRun) {
      offer(run.before);
    }
  }

  const FeedCells& cells_;
  const FeedSearch& search_;
  FewFeeds few_;
  std::vector<Run> run_;  ///< at the first cell of each
  std::priority_queue<Union, std::vector<Union>, std::greater<>> queue_;
  double loss_s_ = 0.0;
};

}  // namespace

std::vector<std::uint32_t> group_feeds(const FeedCells& cells, const FeedSearch& search,
                                       const FewFeeds& few, std::vector<double>& ratio) {
  Grouping grouping(cells, search, few, ratio);
  grouping.unite();
  return grouping.take(ratio);
}

}  // namespace steadyrest::contour::offline
