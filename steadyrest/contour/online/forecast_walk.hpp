// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <optional>

#include <steadyrest/contour/online/forecast.hpp>
#include <steadyrest/math/geometry/vector.hpp>

/// One forecast's state and its steps; of forecast.cpp alone.
namespace steadyrest::contour::online {

/// Distance to one cell, squared, and the offset from its start to the foot.
struct Near {
  double squared = 0.0;
  double delta = 0.0;
  kernel::signal::Point offset{};
};

// Distance from q to p(δ) = δ·t + ½δ²·κ⃗ is stationary where (q − p)·(t + δ·κ⃗) = 0, to first
// order δ = q·t/(1 − q·κ⃗). Beyond the centre of curvature the divisor goes to 0; 0.2 bounds it.
inline Near near_on_cell(const Cell& cell, const kernel::signal::Point& query) noexcept {
  const kernel::signal::Point from = math::geometry::subtract(query, cell.point_mm);
  // One Newton step on the parabola from the tangent's foot: exact to second order in the offset.
  const double along = math::geometry::dot(from, cell.tangent);
  const double bend = 1.0 - math::geometry::dot(from, cell.curvature_1_mm);
  const double delta = std::clamp(along / std::max(bend, 0.2), 0.0, cell.length_mm);
  const kernel::signal::Point foot = math::geometry::add_scaled(
      math::geometry::scale(cell.tangent, delta), cell.curvature_1_mm, 0.5 * delta * delta);
  const kernel::signal::Point offset = math::geometry::subtract(from, foot);
  return {math::geometry::norm_squared(offset), delta, offset};
}

/// The foot point as it moves along the cells. Inside a corner the foot never reaches the end of
/// the first leg, so the first cell behind the next corner is tracked as well, and wins once it is
/// nearer.
class Forecast::FootTracker {
 public:
  FootTracker(const LookAhead& path, std::size_t cell) noexcept
      : path_(path), cell_(cell), scanned_(cell) {}

  // Cells between foot and command are searched once for corners: amortised, one per step.
  Near update(const kernel::signal::Point& query, std::size_t command_cell) noexcept {
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

  Near advance(std::size_t& cell, const kernel::signal::Point& query,
               std::size_t command_cell) const noexcept {
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
        velocity(math::geometry::scale(
            math::geometry::add_scaled(cell->tangent, cell->curvature_1_mm, s - cell->position_mm),
            v)),
        servo(from.servo),
        foot(cells, std::min(from.foot_cell, at)),
        tool(from.tool),
        offset(from.offset) {
    if (slow()) {
      for (std::size_t i = 0; i < 3; ++i) {
        command[i] += offset[i].at_mm;
      }
    } else if (tool) {
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
  [[nodiscard]] kernel::signal::Point commanded_for_tool(
      const kernel::signal::Point& program) const noexcept {
    kernel::signal::Point out;
    for (std::size_t i = 0; i < 3; ++i) {
      out[i] = program[i] + std::clamp(tool->command_mm[i] - program[i], -of.most_offset_mm_,
                                       of.most_offset_mm_);
    }
    return out;
  }

  [[nodiscard]] bool slow() const noexcept { return of.offset_acceleration_mm_s2_ > 0.0; }

  /// The same where the offsets follow with a limited acceleration, or go to 0.
  [[nodiscard]] kernel::signal::Point commanded_slowly(
      const kernel::signal::Point& program) noexcept {
    const bool follows = tool && outset.follows;
    const kernel::signal::Point wanted = follows ? commanded_for_tool(program) : program;
    kernel::signal::Point out;
    for (std::size_t i = 0; i < 3; ++i) {
      offset[i].follow(wanted[i] - program[i], of.offset_acceleration_mm_s2_, of.timing_.step_s);
      out[i] = program[i] + offset[i].at_mm;
    }
    return out;
  }

  /// The servos follow the commanded point, which was at the path length `from_mm`, and the table
  /// follows them; where it is.
  // The tool point's command carries no velocity: its mean over the step before is used instead.
  kernel::signal::Point follow(double from_mm) noexcept {
    const double h = of.timing_.step_s;
    const double delta = s - cell->position_mm;
    const kernel::signal::Point before = command;
    command = on_cell(*cell, delta);
    const kernel::signal::Point tangent =
        math::geometry::add_scaled(cell->tangent, cell->curvature_1_mm, delta);
    kernel::signal::Point velocity1 = math::geometry::scale(tangent, v);
    if (tool) {
      of.tool_point_.advance(path, from_mm, s, h, *tool);
    }
    if (tool || slow()) {
      command = slow() ? commanded_slowly(command) : commanded_for_tool(command);
      velocity1 = math::geometry::scale(math::geometry::subtract(command, before), 1.0 / h);
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
      const double inward = math::geometry::dot(near.offset, under.curvature_1_mm);
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
  kernel::signal::Point command;
  kernel::signal::Point velocity;
  ServoState servo;
  kernel::signal::Point table{};
  FootTracker foot;
  std::optional<ToolPoint::State> tool;
  std::array<kernel::offset::LimitedFollower, 3> offset;
  double worst = 0.0;  ///< error squared
  std::size_t trace_at = 0;
  Result result;
};

}  // namespace steadyrest::contour::online
