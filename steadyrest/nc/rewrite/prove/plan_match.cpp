// SPDX-License-Identifier: Apache-2.0
#include <cmath>
#include <limits>

#include <fmt/core.h>

#include <steadyrest/nc/rewrite/prove/compare.hpp>
#include <steadyrest/nc/rewrite/prove/plan_match.hpp>

namespace steadyrest::nc::rewrite {
namespace {

constexpr double kNever = std::numeric_limits<double>::infinity();

/// How many of the steps may have been answered so far: ascending, never empty.
/// A change in the text may answer one step, or several that share a place; steps that cancel may
/// be answered by none. The text does not say which, so every possibility is kept: `answered_` has
/// each number of steps that may have been answered so far.
using Answered = std::vector<std::size_t>;

class Match {
 public:
  Match(const AxisPlan& axis, const Settings& settings) : axis_(axis), settings_(settings) {}

  /// Adds the numbers reached by groups that change nothing between two instants. Of the groups
  /// that end with a step, the shortest is the easiest to place, so only that one is tried.
  void pass_over(double from_s, double to_s) {
    Answered reached;
    std::size_t next = 0;
    // A number is reached if it was reached before, or from a lower one by steps that cancel.
    for (std::size_t step = answered_.front(); step <= axis_.steps.size(); ++step) {
      const bool before = next < answered_.size() && answered_[next] == step;
      next += before ? 1U : 0U;
      if (before ||
          (step > 0 && !reached.empty() && silent(reached.back(), step - 1, from_s, to_s))) {
        reached.push_back(step);
      }
    }
    answered_ = std::move(reached);
  }

  /// Takes the groups that end with the change. False when there is none.
  bool take(const WrittenChange& change) {
    Answered reached;
    std::size_t next = 0;
    for (std::size_t step = answered_.front(); step < axis_.steps.size(); ++step) {
      // From the highest number not above this step: the shortest group.
      while (next + 1 < answered_.size() && answered_[next + 1] <= step) {
        ++next;
      }
      if (near(answered_[next], change) && near(step, change) && stands(step, change.stands_mm)) {
        reached.push_back(step + 1);
      }
    }
    if (reached.empty()) {
      return false;
    }
    answered_ = std::move(reached);
    return true;
  }

  void now(double stands_mm, double unit_mm) noexcept {
    stands_mm_ = stands_mm;
    unit_mm_ = unit_mm;
  }
  [[nodiscard]] bool stands(std::size_t step, double stands_mm) const noexcept {
    return same(stands_mm, correction_mm(settings_, unit_mm_, axis_.steps[step].displacement_um));
  }
  [[nodiscard]] std::size_t most_answered() const noexcept { return answered_.back(); }

 private:
  [[nodiscard]] bool near(std::size_t step, const WrittenChange& change) const noexcept {
    return std::abs(axis_.steps[step].time_s - change.time_s) <= settings_.window_s;
  }
  [[nodiscard]] bool silent(std::size_t first, std::size_t last, double from_s,
                            double to_s) const noexcept {
    // One instant must lie in the windows of all steps of the group and between the two changes,
    // and the last step must leave the correction unchanged.
    const double earliest_s = axis_.steps[last].time_s - settings_.window_s;
    const double latest_s = axis_.steps[first].time_s + settings_.window_s;
    return earliest_s <= latest_s && earliest_s <= to_s && latest_s >= from_s &&
           stands(last, stands_mm_);
  }

  const AxisPlan& axis_;
  const Settings& settings_;
  Answered answered_ = {0};
  double stands_mm_ = 0.0;
  double unit_mm_ = 1.0;
};

}  // namespace

std::optional<Mismatch> mismatch(const AxisPlan& axis, const Settings& settings,
                                 const std::vector<WrittenChange>& changes) {
  Match match(axis, settings);
  double now_s = 0.0;
  double stands_mm = 0.0;
  for (const WrittenChange& change : changes) {
    // The unit of this change: rounding depends on it.
    match.now(stands_mm, change.unit_mm);
    match.pass_over(now_s, change.time_s);
    if (!match.take(change)) {
      // For the message: a later step with this sum means the wrong time; otherwise the plan has no
      // such sum.
      std::size_t step = match.most_answered();
      while (step < axis.steps.size() && !match.stands(step, change.stands_mm)) {
        ++step;
      }
      return Mismatch{change.line,
                      step == axis.steps.size()
                          ? fmt::format("{} is corrected by {:.6f} mm from here; after {:.6f} mm "
                                        "the plan has no such correction",
                                        axis.letter, change.stands_mm, stands_mm)
                          : fmt::format("a correction of {} acts at {:.1f} s; it is planned at "
                                        "{:.1f} s, and may be {:g} s off",
                                        axis.letter, change.time_s, axis.steps[step].time_s,
                                        settings.window_s)};
    }
    now_s = change.time_s;
    stands_mm = change.stands_mm;
    match.now(stands_mm, change.unit_mm);
  }
  // After the last change only steps that cancel may remain.
  match.pass_over(now_s, kNever);
  if (match.most_answered() == axis.steps.size()) {
    return {};
  }
  return Mismatch{0, fmt::format("the correction of {} planned at {:.1f} s is missing", axis.letter,
                                 axis.steps[match.most_answered()].time_s)};
}

}  // namespace steadyrest::nc::rewrite
