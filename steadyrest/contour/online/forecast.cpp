// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <cmath>

#include <steadyrest/contour/online/forecast.hpp>
#include <steadyrest/math/geometry/vector.hpp>

// A forecast walks in steps of a few milliseconds. Each step: the ratio that acts then, the
// control's speed under it, the three servos by their exact step, the foot on the path, the error
// against the limit. There is no search and no backtracking, so its cost is its number of steps.
namespace steadyrest::contour::online {
namespace {

namespace geometry = math::geometry;
using kernel::signal::Point;

constexpr double kRatioTolerance = 1e-9;  // as the kernel's table has it

/// Distance to one cell, squared, and the offset from its start to the foot.
struct Near {
  double squared = 0.0;
  double delta = 0.0;
  Point offset{};
};

// Distance from q to p(δ) = δ·t + ½δ²·κ⃗ is stationary where (q − p)·(t + δ·κ⃗) = 0, to first
// order δ = q·t/(1 − q·κ⃗). Beyond the centre of curvature the divisor goes to 0; 0.2 bounds it.
Near near_on_cell(const Cell& cell, const Point& query) noexcept {
  const Point from = geometry::subtract(query, cell.point_mm);
  // One Newton step on the parabola from the tangent's foot: exact to second order in the offset.
  const double along = geometry::dot(from, cell.tangent);
  const double bend = 1.0 - geometry::dot(from, cell.curvature_1_mm);
  const double delta = std::clamp(along / std::max(bend, 0.2), 0.0, cell.length_mm);
  const Point foot = geometry::add_scaled(geometry::scale(cell.tangent, delta), cell.curvature_1_mm,
                                          0.5 * delta * delta);
  const Point offset = geometry::subtract(from, foot);
  return {geometry::norm_squared(offset), delta, offset};
}

}  // namespace

/// The foot point as it moves along the cells. Inside a corner the foot never reaches the end of
/// the first leg, so the first cell behind the next corner is tracked as well, and wins once it is
/// nearer.
class Forecast::FootTracker {
 public:
  FootTracker(const LookAhead& path, std::size_t cell) noexcept
      : path_(path), cell_(cell), scanned_(cell) {}

  // Cells between foot and command are searched once for corners: amortised, one per step.
  Near update(const Point& query, std::size_t command_cell) noexcept {
    Near here = advance(cell_, query, command_cell);
    if (beyond_ != kNone && beyond_ <= cell_) {
      beyond_ = kNone;
    }
    while (beyond_ == kNone && scanned_ < command_cell) {
      ++scanned_;
      if (scanned_ > cell_ && path_.cell(scanned_).corner) {
        beyond_ = scanned_;
      }
    }
    if (beyond_ != kNone) {
      const Near there = advance(beyond_, query, command_cell);
      if (there.squared <= here.squared) {
        cell_ = beyond_;
        beyond_ = kNone;
        return there;
      }
    }
    return here;
  }
  [[nodiscard]] std::size_t cell() const noexcept { return cell_; }

 private:
  static constexpr std::size_t kNone = static_cast<std::size_t>(-1);

  Near advance(std::size_t& cell, const Point& query, std::size_t command_cell) const noexcept {
    Near here = near_on_cell(path_.cell(cell), query);
    while (here.delta >= path_.cell(cell).length_mm && cell < command_cell) {
      const Near next = near_on_cell(path_.cell(cell + 1), query);
      if (next.squared > here.squared) {
        break;
      }
      here = next;
      ++cell;
    }
    return here;
  }

  const LookAhead& path_;
  std::size_t cell_;
  std::size_t beyond_ = kNone;
  std::size_t scanned_;
};

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

/// The state of one forecast, and its step in three parts: control, servos, contour.
struct Forecast::Walk {
  Walk(const Forecast& forecast, const LookAhead& cells, const Outset& from) noexcept
      : of(forecast),
        path(cells),
        outset(from),
        s(from.position_mm),
        v(from.speed_mm_s),
        at(from.command_cell),
        cell(&cells.cell(at)),
        command(on_cell(*cell, s - cell->position_mm)),
        velocity(geometry::scale(
            geometry::add_scaled(cell->tangent, cell->curvature_1_mm, s - cell->position_mm), v)),
        servo(from.servo),
        foot(cells, std::min(from.foot_cell, at)),
        tool(from.tool) {
    if (tool) {
      command = commanded_for_tool(command);
    }
    for (std::size_t i = 0; i < 3; ++i) {
      table[i] = command[i] - servo.error_mm[i] + from.play_mm[i];
    }
  }

  /// Until the override has completed the plan and everything has settled.
  [[nodiscard]] std::size_t steps(const RatioPlan& plan) const noexcept {
    const Timing& timing = of.timing_;
    const double change_s = plan.target > plan.start ? (plan.target - plan.start) / timing.rise_1_s
                                                     : (plan.start - plan.target) / timing.fall_1_s;
    const double held_until_s = timing.dead_s + timing.scan_s + change_s + plan.hold_s;
    const double fall_s = std::max(0.0, plan.target - plan.floor) / timing.fall_1_s;
    const double brake_s = v / std::max(1.0, cell->acceleration_mm_s2);
    const double horizon_s = held_until_s + fall_s + brake_s + timing.settle_s;
    return std::min(kMaxSteps, static_cast<std::size_t>(std::ceil(horizon_s / timing.step_s)));
  }

  /// The ratio that acts in step n, which ends at `t_s`.
  [[nodiscard]] double ratio_in(std::size_t n, double t_s, const RatioPlan& plan) const noexcept {
    double ratio = n <= of.pending_count_ ? of.pending_[n - 1] : 0.0;
    if (t_s > of.timing_.dead_s) {
      ratio = std::max(ratio, of.floor_ratio(of.planned(plan, t_s)));
    }
    return std::min(ratio, outset.panel_ratio);
  }

  /// The control's speed; false when the path that follows is unknown.
  bool advance(double ratio) noexcept {
    const double h = of.timing_.step_s;
    // The feed override scales cutting moves; rapids have their own.
    const auto target_of = [&](const Cell& c) {
      const double share = c.cutting ? ratio : c.rapid ? outset.rapid_ratio : 1.0;
      return std::min(c.cap_mm_s, c.feed_mm_s * share);
    };
    const double goal = target_of(*cell);
    const double dv = cell->acceleration_mm_s2 * h;
    double v1 = v < goal ? std::min(goal, v + dv) : std::max(goal, v - dv);
    double s1 = s + 0.5 * (v + v1) * h;
    double left = cell->position_mm + cell->length_mm - s1;
    // Several cells may fall into one step. The one that contains s₁ decides.
    std::size_t next = at;
    while (left < 0.0 && next + 1 < path.end()) {
      ++next;
      const Cell& c = path.cell(next);
      left = c.position_mm + c.length_mm - s1;
    }
    const Cell& ahead = path.cell(next);
    if (left < 0.0) {
      // Anything may follow the known cells: the forecast ends. At the path's end the axis stops.
      if (!path.complete()) {
        return false;
      }
      s1 += left;
      v1 = 0.0;
      left = 0.0;
    }
    if (next + 1 < path.end()) {
      const Cell& after = path.cell(next + 1);
      // v² from which braking over the rest can still reach the next cell's limit.
      const double slower = target_of(after);
      const double square =
          std::min(after.square_mm2_s2, slower * slower) + 2.0 * ahead.acceleration_mm_s2 * left;
      if (v1 * v1 > square) {
        // Rounding may ask for more than the brake can give; the limit is two steps' worth.
        v1 = std::max(std::sqrt(square), v - 2.0 * dv);
        s1 = s + 0.5 * (v + v1) * h;
      }
    }
    s = s1;
    at = next;
    if (next + 1 < path.end() && v1 * h >= left && path.cell(next + 1).square_mm2_s2 <= dv * dv) {
      // A stop on the path: reached within this step and left again in the next.
      ++at;
      s = path.cell(at).position_mm;
      v1 = 0.0;
    }
    v = v1;
    cell = &path.cell(at);
    return true;
  }

  /// What the axes are commanded while the program's command is at `program`: the tool point's
  /// command, as far as an offset may go.
  [[nodiscard]] Point commanded_for_tool(const Point& program) const noexcept {
    Point out;
    for (std::size_t i = 0; i < 3; ++i) {
      out[i] = program[i] + std::clamp(tool->command_mm[i] - program[i], -of.most_offset_mm_,
                                       of.most_offset_mm_);
    }
    return out;
  }

  /// The servos follow the commanded point, which was at the path length `from_mm`, and the table
  /// follows them; where it is.
  // The tool point's command carries no velocity: its mean over the step before is used instead.
  Point follow(double from_mm) noexcept {
    const double h = of.timing_.step_s;
    const double delta = s - cell->position_mm;
    const Point before = command;
    command = on_cell(*cell, delta);
    const Point tangent = geometry::add_scaled(cell->tangent, cell->curvature_1_mm, delta);
    Point velocity1 = geometry::scale(tangent, v);
    if (tool) {
      of.tool_point_.advance(path, from_mm, s, h, *tool);
      command = commanded_for_tool(command);
      velocity1 = geometry::scale(geometry::subtract(command, before), 1.0 / h);
    }
    for (std::size_t i = 0; i < 3; ++i) {
      const AxisStep& step = of.step_[i];
      const double mean = (command[i] - before[i]) / h;
      const double change = velocity1[i] - velocity[i];
      const double e = servo.error_mm[i];
      const double w = servo.velocity_mm_s[i];
      servo.error_mm[i] = step.ee * e + step.ew * w + step.e_mean * mean + step.e_change * change;
      servo.velocity_mm_s[i] =
          step.we * e + step.ww * w + step.w_mean * mean + step.w_change * change;
      const double motor = command[i] - servo.error_mm[i];
      const double play = of.half_backlash_mm_[i];
      table[i] = std::clamp(table[i], motor - play, motor + play);
    }
    velocity = velocity1;
    return table;
  }

  /// Keeps the largest error; false when it exceeds the limit here.
  bool judge(const Near& near, const Cell& under, double limit_mm, const Trace* trace) noexcept {
    if (near.squared > worst) {
      worst = near.squared;
      // Positive towards the centre: the part comes out undersize.
      const double inward = geometry::dot(near.offset, under.curvature_1_mm);
      result.error_mm = std::copysign(std::sqrt(worst), inward);
      result.at_mm = s;
    }
    double allowed = limit_mm;
    if (near.squared > allowed * allowed && trace != nullptr) {
      while (trace_at + 1 < trace->count && trace->position_mm[trace_at + 1] <= s) {
        ++trace_at;
      }
      if (trace_at < trace->count) {
        allowed = std::max(allowed, trace->error_mm[trace_at]);
      }
    }
    if (!(near.squared > allowed * allowed)) {
      return true;
    }
    if (result.kept) {
      // By the foot: the tool is there.
      result.broken_mm = under.position_mm + near.delta;
    }
    result.kept = false;
    return false;
  }

  const Forecast& of;
  const LookAhead& path;
  const Outset& outset;
  double s;  ///< commanded path length
  double v;  ///< commanded path speed
  std::size_t at;
  const Cell* cell;  ///< of the commanded point
  Point command;
  Point velocity;
  ServoState servo;
  Point table{};
  FootTracker foot;
  std::optional<ToolPoint::State> tool;
  double worst = 0.0;  ///< error squared
  std::size_t trace_at = 0;
  Result result;
};

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
    // In air the error does not matter; within the dead time nothing can change it.
    if (!under.cutting || t <= std::max(timing_.dead_s, plan.judged_from_s)) {
      continue;
    }
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

}  // namespace steadyrest::contour::online
