// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <cmath>
#include <string_view>
#include <utility>

#include <fmt/core.h>

#include <steadyrest/kernel/units/convert.hpp>
#include <steadyrest/nc/interpret/decode/dialect_rules.hpp>
#include <steadyrest/nc/interpret/state/step.hpp>
#include <steadyrest/nc/plan/check/machine_check.hpp>
#include <steadyrest/nc/plan/check/reach.hpp>
#include <steadyrest/nc/plan/path/spline_lines.hpp>

namespace steadyrest::nc::plan {
namespace {

using interpret::Event;
using interpret::EventKind;
using interpret::kAxisLetters;
using interpret::Move;
using interpret::MoveKind;
using kernel::units::mm_min_from_mm_s;
using kernel::units::rpm_from_rev_s;

constexpr double kRounding_mm = 1e-6;
constexpr double kSpeedRounding = 1e-6;  ///< of a speed
constexpr std::size_t kMostSeen = 100'000;

bool feeds(const Move& move) {
  return move.kind == MoveKind::linear || move.kind == MoveKind::arc ||
         move.kind == MoveKind::spline;
}

constexpr double kChord_mm = 1e-3;

/// Where the axis goes. Of a line only the end counts, since the start of the first one is unknown;
/// of a spline the curve, not its control points.
Reach goes_to(const Move& move, std::size_t axis) {
  if (move.kind == MoveKind::arc) {
    return reach_of(move, axis);
  }
  const double end_mm = interpret::machine_of(move, move.end)[axis];
  Reach reach{.low_mm = end_mm, .high_mm = end_mm};
  if (move.kind == MoveKind::spline) {
    spline_lines(move, kChord_mm, [&](const Move& chord) {
      const double at_mm = interpret::machine_of(chord, chord.end)[axis];
      reach.low_mm = std::min(reach.low_mm, at_mm);
      reach.high_mm = std::max(reach.high_mm, at_mm);
    });
  }
  return reach;
}

}  // namespace

MachineCheck::MachineCheck(const kernel::machine::Machine& machine, const Known& known)
    : machine_(machine),
      known_(known),
      pieces_(machine),
      always_mm_s_(machine.control.max_feed_mm_s) {
  // always_mm_s_: the feed that every linear axis and the control can do. At this feed no direction
  // overloads any of them, since |t_i| ≤ 1.
  for (const kernel::machine::Axis& axis : machine.axes) {
    const std::size_t at =
        axis.name.size() == 1 ? kAxisLetters.find(axis.name[0]) : kAxisLetters.size();
    if (at < axis_.size() && !axis.rotary && axis.present) {
      axis_[at] = &axis;
    }
    if (!axis.rotary && axis.present) {
      always_mm_s_ = std::min(always_mm_s_, axis.max_speed_au_s);
    }
    lathe_ = lathe_ || (axis.name == "Y" && !axis.present);
  }
}

// Whether the end of the move is known in machine coordinates, tool and offset included.
bool MachineCheck::placed(const Move& move, std::size_t axis) const noexcept {
  // Tool lengths act in Z, on a lathe in X too.
  const bool by_tool = axis == 2 || (axis == 0 && lathe_);
  const bool length = known_.tools || !tool_came_ || !by_tool;
  if ((move.machine_axes >> axis & 1U) != 0) {  // SUPA keeps the tool length
    return length || !interpret::rules_of(machine_.control.dialect).tool_in_machine_frame;
  }
  return known_.offsets && length;
}

void MachineCheck::on_move(const Move& move) {
  if (move.kind == MoveKind::dwell) {
    return;
  }
  for (std::size_t axis = 0; axis < axis_.size(); ++axis) {
    if (axis_[axis] != nullptr) {
      check_travel(move, axis);
    }
  }
  if (feeds(move)) {
    check_feed(move);
    check_block(move);
    check_blend(move);
    check_stopped(move);
  }
}

void MachineCheck::check_travel(const Move& move, std::size_t axis) {
  const kernel::machine::Axis& limits = *axis_[axis];
  const Reach reach = goes_to(move, axis);
  // An axis that does not move is not checked: the move that took it there was.
  const double start_mm = interpret::machine_of(move, move.start)[axis];
  if (reach.low_mm == start_mm && reach.high_mm == start_mm) {
    return;
  }
  const bool over =
      reach.high_mm > limits.max_au + kRounding_mm || reach.low_mm < limits.min_au - kRounding_mm;
  if (placed(move, axis)) {
    if (over) {
      const double to_mm =
          reach.high_mm > limits.max_au + kRounding_mm ? reach.high_mm : reach.low_mm;
      warn(
          move.line, What::travel, axis,
          fmt::format("{} {} to {:.3f} mm, outside its travel {:g} … {:g} mm (machine coordinates)",
                      move.kind == MoveKind::rapid ? "a rapid takes" : "the move takes",
                      limits.name, to_mm, limits.min_au, limits.max_au));
    }
    return;
  }
  // A rapid within the travel may go to a fixed position (G28), which says nothing about the part.
  if (move.kind == MoveKind::rapid && !over) {
    return;
  }
  Extent& extent = extent_[axis];
  extent.low_mm = std::min(extent.low_mm, reach.low_mm);
  extent.high_mm = std::max(extent.high_mm, reach.high_mm);
  // A range wider than the travel fits under no work offset, so the offset need not be known.
  if (extent.line == 0 &&
      extent.high_mm - extent.low_mm > limits.max_au - limits.min_au + kRounding_mm) {
    extent.line = move.line;
    seen_.emplace(move.line, What::extent, axis);
  }
}

void MachineCheck::check_feed(const Move& move) {
  constexpr std::size_t kLinear = 3;
  // With rotary axes the feed is along X Y Z, or in degrees: the shortcut does not hold.
  const bool turns =
      !std::equal(move.start.begin() + kLinear, move.start.end(), move.end.begin() + kLinear);
  if (!turns && move.feed_mode == interpret::FeedMode::per_minute &&
      move.feed_mm_s <= always_mm_s_) {
    return;  // most moves
  }
  const auto made = pieces_.make(move, piece_);
  if (!made || !*made) {
    return;  // no length, or refused by whoever plans it
  }
  const SegmentPlan& plan = piece_.plan;
  const double feed_mm_s =
      plan.feed_mm_s * (plan.per_revolution ? std::abs(move.spindle_rev_s) : 1.0);
  // Axis speeds only. An arc's centripetal limit is left to the planner: every control slows down
  // for it, so it does not make F wrong.
  const double axes_mm_s = move.kind == MoveKind::arc
                               ? pieces_.limits().plane(piece_.segment.axis).speed_mm_s
                               : pieces_.limits().line(piece_.end_direction).speed_mm_s;
  const double most_mm_s = std::min(axes_mm_s, machine_.control.max_feed_mm_s);
  if (feed_mm_s <= most_mm_s * (1.0 + kSpeedRounding) || feed_mm_s == feed_warned_mm_s_) {
    return;
  }
  // Once for each feed, not for each block.
  feed_warned_mm_s_ = feed_mm_s;
  warn(move.line, What::feed, 0,
       fmt::format("the feed of {:.9g} mm/min is more than the {} can do here, {:.9g} mm/min",
                   mm_min_from_mm_s(feed_mm_s),
                   axes_mm_s <= machine_.control.max_feed_mm_s ? "axes" : "control",
                   mm_min_from_mm_s(most_mm_s)));
}

void MachineCheck::check_block(const Move& move) {
  const auto& control = machine_.control;
  const double block_s = kernel::machine::least_block_s(control);
  if (block_warned_ || control.dialect == kernel::machine::Dialect::linuxcnc || block_s <= 0.0 ||
      move.kind == MoveKind::spline || move.feed_mode != interpret::FeedMode::per_minute) {
    return;
  }
  const double far_mm = std::hypot(move.end[0] - move.start[0], move.end[1] - move.start[1],
                                   move.end[2] - move.start[2]);
  if (far_mm >= move.feed_mm_s * block_s) {
    return;  // an arc is longer than its chord
  }
  const auto made = pieces_.make(move, piece_);
  if (!made || !*made || piece_.nominal_mm >= move.feed_mm_s * block_s) {
    return;
  }
  block_warned_ = true;
  const std::string slowed = fmt::format(
      "{:.4g} mm at {:.9g} mm/min take {:.3g} ms, less than a block takes on the control ({:g} "
      "ms): "
      "it slows to {:.4g} mm/min",
      piece_.nominal_mm, mm_min_from_mm_s(move.feed_mm_s), 1e3 * piece_.nominal_mm / move.feed_mm_s,
      1e3 * block_s, mm_min_from_mm_s(piece_.nominal_mm / block_s));
  warn(move.line, What::block, 0,
       kernel::machine::knows_block_time(control)
           ? slowed
           : slowed +
                 "; that time is not known, so the worst is assumed: set block_time_ms in "
                 "[control]");
}

void MachineCheck::check_blend(const Move& move) {
  constexpr double kSmall_mm = 5.0;
  const bool overdone = machine_.control.planner == kernel::machine::LinuxCncPlanner::s_curve &&
                        move.kind == MoveKind::arc &&
                        move.path_mode == interpret::PathMode::continuous &&
                        move.path_tolerance_mm > 0.0;
  if (blend_warned_ || !overdone) {
    return;
  }
  const auto made = pieces_.make(move, piece_);
  if (!made || !*made || piece_.segment.radius_mm > kSmall_mm) {
    return;
  }
  blend_warned_ = true;
  warn(move.line, What::blend, 0,
       fmt::format("blends at an arc of {:.3g} mm under G64 P{:g}: LinuxCNC 2.10's S-curve planner "
                   "has gone up to 8 times beyond the axes' acceleration there (its issue 3773); "
                   "use G61, or a smaller P",
                   piece_.segment.radius_mm, move.path_tolerance_mm));
}

void MachineCheck::check_stopped(const Move& move) {
  const bool is_stopped = move.spindle_rev_s == 0.0 && move.surface_speed_mm_s == 0.0;
  if (is_stopped && !stopped_warned_) {
    warn(move.line, What::standing, 0,
         "cuts with the spindle stopped: no S with M3 or M4 is in force");
  }
  stopped_warned_ = is_stopped;
}

// From the first tool change on, Z (on a lathe X too) depends on a length that only the tool table
// knows.
void MachineCheck::on_event(const Event& event) {
  if (event.kind == EventKind::tool_change) {
    tool_came_ = true;
  }
  if (event.kind != EventKind::spindle || event.value == 0.0) {
    return;
  }
  const double speed_rev_s = std::abs(event.value);
  const auto& spindle = machine_.spindle;
  if (speed_rev_s > spindle.max_rev_s * (1.0 + kSpeedRounding) ||
      speed_rev_s < spindle.min_rev_s * (1.0 - kSpeedRounding)) {
    warn(event.line, What::spindle, 0,
         fmt::format("S{:.6g} is outside the spindle's {:.6g} … {:.6g} rev/min",
                     rpm_from_rev_s(speed_rev_s), rpm_from_rev_s(spindle.min_rev_s),
                     rpm_from_rev_s(spindle.max_rev_s)));
  }
}

// Loops and subprograms repeat their lines: one warning for each line, kind and axis. count()
// continues past the kMost that are kept, up to a second bound, so memory stays small.
void MachineCheck::warn(std::uint32_t line, What what, std::size_t axis, std::string text) {
  if (seen_.size() < kMostSeen && seen_.emplace(line, what, axis).second &&
      warnings_.size() < kMost) {
    warnings_.push_back({line, std::move(text), what == What::travel});
  }
}

std::vector<Warning> MachineCheck::warnings() const {
  std::vector<Warning> out = warnings_;
  for (std::size_t axis = 0; axis < extent_.size(); ++axis) {
    const Extent& extent = extent_[axis];
    if (extent.line > 0) {
      out.push_back({extent.line,
                     fmt::format("the program covers {:.3f} mm of {}, from {:.3f} to {:.3f} mm; "
                                 "its travel is only {:g} mm, whatever the work offset",
                                 extent.high_mm - extent.low_mm, axis_[axis]->name, extent.low_mm,
                                 extent.high_mm, axis_[axis]->max_au - axis_[axis]->min_au),
                     true});
    }
  }
  std::ranges::stable_sort(out, {}, &Warning::line);
  return out;
}

}  // namespace steadyrest::nc::plan
