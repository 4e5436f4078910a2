// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <cmath>
#include <limits>

#include <steadyrest/contour/online/forecast.hpp>
#include <steadyrest/contour/online/forecast_walk.hpp>

// A forecast walks in steps of a few milliseconds. Each step: the ratio that acts then, the
// control's speed under it, the three servos by their exact step, the foot on the path, the error
// against the limit. There is no search and no backtracking, so its cost is its number of steps.
namespace steadyrest::contour::online {
namespace {

using kernel::signal::Point;

constexpr std::size_t kEvery = 2;         ///< steps, of a mean over many
constexpr std::size_t kAround = 12;       ///< cells either way
constexpr double kRatioTolerance = 1e-9;  // as the kernel's table has it

/// To the path around a cell that the tool is near to.
double nearest_square(const LookAhead& path, std::size_t cell, const Point& query) noexcept {
  const std::size_t first = std::max(path.begin(), cell - std::min(cell, kAround));
  const std::size_t end = std::min(path.end(), cell + kAround + 1);
  double least = std::numeric_limits<double>::infinity();
  for (std::size_t i = first; i < end; ++i) {
    least = std::min(least, near_on_cell(path.cell(i), query).squared);
  }
  return least;
}

}  // namespace

void Forecast::set_timing(const Timing& timing) noexcept {
  timing_ = timing;
}

void Forecast::set_model(std::span<const AxisModel, 3> model) noexcept {
  for (std::size_t i = 0; i < 3; ++i) {
    model_[i] = model[i];
    step_[i] = AxisStep::of(model[i], timing_.step_s);
  }
}

void Forecast::set_tool_point(const ToolPoint& tool_point, double most_mm) noexcept {
  tool_point_ = tool_point;
  most_offset_mm_ = most_mm;
}

void Forecast::set_table(std::span<const double> ratio) noexcept {
  table_count_ = std::min(ratio.size(), kMaxTable);
  std::copy_n(ratio.begin(), table_count_, table_.begin());
}

double Forecast::floor_ratio(double ratio) const noexcept {
  const auto* const begin = table_.begin();
  const auto* const end = begin + table_count_;
  const auto* const above = std::upper_bound(begin, end, ratio + kRatioTolerance);
  return above == begin ? *begin : *(above - 1);
}

// A rise is assumed to act as early as possible (after the dead time), a fall as late as possible
// (a scan later): the worse case of both for the contour.
double Forecast::planned(const RatioPlan& plan, double t_s) const noexcept {
  const double since = t_s - timing_.dead_s;
  const double late = since - timing_.scan_s;
  if (plan.target > plan.start) {
    const double reached = (plan.target - plan.start) / timing_.rise_1_s;
    const double falling = late - reached - plan.hold_s;
    if (falling > 0.0) {
      return std::max(plan.floor, plan.target - timing_.fall_1_s * falling);
    }
    return std::min(plan.target, plan.start + timing_.rise_1_s * since);
  }
  if (late <= 0.0) {
    return plan.start;
  }
  const double reached = (plan.start - plan.target) / timing_.fall_1_s;
  if (late <= reached) {
    return plan.start - timing_.fall_1_s * late;
  }
  const double falling = late - reached - plan.hold_s;
  return falling <= 0.0 ? plan.target
                        : std::max(plan.floor, plan.target - timing_.fall_1_s * falling);
}

Forecast::Squares Forecast::squares(const LookAhead& path, const Outset& outset, double ratio,
                                    double time_s) const noexcept {
  Walk walk(*this, path, outset);
  const auto count = std::min(kMaxSteps, static_cast<std::size_t>(time_s / timing_.step_s));
  Squares out;
  std::size_t cut = 0;
  for (std::size_t n = 1; n <= count && walk.tool; ++n) {
    const double from_mm = walk.s;
    if (!walk.advance(ratio)) {
      break;
    }
    const Point table = walk.follow(from_mm);
    out.steps = n;
    const Cell& under = path.cell(walk.tool->cell);
    if (under.cutting && !under.by_text && n % kEvery == 0) {
      const double square = nearest_square(path, walk.tool->cell, table);
      out.mean_mm2 += square;
      out.largest_mm2 = std::max(out.largest_mm2, square);
      ++cut;
    }
  }
  out.mean_mm2 /= static_cast<double>(std::max<std::size_t>(1, cut));
  return out;
}

Forecast::Result Forecast::run(const LookAhead& path, const Outset& outset, const RatioPlan& plan,
                               double limit_mm, bool stop_early, const Trace* trace,
                               Trace* record) const noexcept {
  Walk walk(*this, path, outset);
  const std::size_t count = walk.steps(plan);
  if (record != nullptr) {
    record->count = 0;
  }
  for (std::size_t n = 1; n <= count; ++n) {
    const double t = timing_.step_s * static_cast<double>(n);
    const double from_mm = walk.s;
    if (!walk.advance(walk.ratio_in(n, t, plan))) {
      break;
    }
    const Near near = walk.foot.update(walk.follow(from_mm), walk.at);
    const Cell& under = path.cell(walk.foot.cell());
    walk.result.steps = n;
    // In air the error does not matter, what the text corrects is not seen here, and within the
    // dead time nothing can change it.
    if (!under.cutting || under.by_text || t <= std::max(timing_.dead_s, plan.judged_from_s)) {
      continue;
    }
    walk.result.judged = true;
    if (record != nullptr) {
      record->position_mm[record->count] = walk.s;
      record->error_mm[record->count] = std::sqrt(near.squared);
      ++record->count;
    }
    if (!walk.judge(near, under, limit_mm, trace) && stop_early) {
      break;
    }
  }
  return walk.result;
}

std::size_t Forecast::carry(const LookAhead& path, double to_mm, double ratio, std::size_t most,
                            Outset& machine) const noexcept {
  const Outset from = machine;
  Walk walk(*this, path, from);
  std::size_t steps = 0;
  while (steps < most && walk.s < to_mm) {
    const double from_mm = walk.s;
    if (!walk.advance(std::min(ratio, from.panel_ratio))) {
      break;
    }
    const Near near = walk.foot.update(walk.follow(from_mm), walk.at);
    machine.foot_mm = path.cell(walk.foot.cell()).position_mm + near.delta;
    ++steps;
  }
  machine.position_mm = walk.s;
  machine.speed_mm_s = walk.v;
  machine.servo = walk.servo;
  machine.command_cell = walk.at;
  machine.foot_cell = walk.foot.cell();
  machine.tool = walk.tool;
  machine.offset = walk.offset;
  for (std::size_t i = 0; i < 3; ++i) {
    machine.play_mm[i] = walk.table[i] - (walk.command[i] - walk.servo.error_mm[i]);
  }
  return steps;
}

}  // namespace steadyrest::contour::online
