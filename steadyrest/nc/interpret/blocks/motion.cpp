// SPDX-License-Identifier: Apache-2.0
#include <bit>
#include <cmath>
#include <numbers>

#include <steadyrest/nc/interpret/blocks/interpreter.hpp>

namespace steadyrest::nc::interpret {
namespace {

constexpr bool is_rotary(std::size_t axis) noexcept {
  return axis >= 3 && axis < 6;
}

bool only_rotary_moves(const Axes& from, const Axes& to) noexcept {
  bool rotary = false;
  for (std::size_t i = 0; i < from.size(); ++i) {
    if (from[i] != to[i]) {
      if (!is_rotary(i)) {
        return false;
      }
      rotary = true;
    }
  }
  return rotary;
}

}  // namespace

/// The word of an axis in mm or degrees.
double Interpreter::component(const Step& step, std::size_t axis) const noexcept {
  const double value = step[kAxisLetters[axis]];
  const double scale = axis == 0 && state_.diameter ? 0.5 * state_.unit_mm : state_.unit_mm;
  return is_rotary(axis) ? value : value * scale;
}

bool Interpreter::move(const Step& step) {
  const int motion = motion_now_;
  if (motion == -1) {
    return true;
  }
  if (motion == g::kCycleEnd) {
    state_.motion = g::kCycleEnd;
    return true;
  }
  if (is_cycle(motion)) {
    return cycle(step);
  }
  if (!spline_points_.empty() && motion != g::kSplinePoint && motion != g::kSplineEnd) {
    return refuse_code(step, 'G', motion / 10, "spline_words",
                       "another motion among the control points of G5.2; G5.3 ends them");
  }
  if (motion >= g::kCubicSpline && motion <= g::kSplineEnd) {
    return spline(step);
  }
  state_.motion = motion;
  cubic_goes_on_ = false;
  if (motion == g::kThread || motion == g::kRigidTap) {
    return thread(step);
  }
  if (motion == g::kThreadCycle) {
    return thread_cycle(step);
  }
  if (motion >= g::kProbeOrFail && motion <= g::kProbeAway) {
    return probe(step);
  }
  return motion == g::kArcClockwise || motion == g::kArcCounterClockwise ? arc(step)
                                                                         : straight(step);
}

// LinuxCNC 2.9 takes the tool's offset off on its way to machine coordinates, but for A, B and C.
bool Interpreter::tool_stays(std::size_t axis) const noexcept {
  return rules_->rotary_tool_in_machine_frame && is_rotary(axis);
}

// G53: the named axes go to machine coordinates, the machine's others stay. The tool's length stays
// in force on SINUMERIK, on the others it is suppressed as well.
void Interpreter::machine_end(const Step& step, Axes& end) {
  const bool keeps_tool = rules_->tool_in_machine_frame;
  Axes machine = to_machine(end);
  for (std::size_t i = 0; i < kAxisLetters.size(); ++i) {
    if (step.has(kAxisLetters[i])) {
      machine[i] = component(step, i) + (keeps_tool || tool_stays(i) ? state_.tool_offset[i] : 0.0);
      move_.machine_axes |= 1U << i;
    }
  }
  const Axes work = to_work(machine);
  for (std::size_t i = 0; i < kAxisLetters.size(); ++i) {
    const bool turns = i < 2 && state_.rotation_in_force_deg != 0.0;
    if (step.has(kAxisLetters[i]) || turns) {
      end[i] = work[i];
    }
  }
}

bool Interpreter::end_point(const Step& step, Axes& end) {
  end = state_.position;
  if (step.machine_frame) {
    machine_end(step, end);
    return true;
  }
  for (std::uint32_t left = step.mask & kAxisMask; left != 0; left &= left - 1) {
    const std::uint32_t bit = left & (~left + 1);
    const std::size_t i = kAxisOfLetter[static_cast<std::size_t>(std::countr_zero(left))];
    const bool incremental =
        (step.incremental & bit) != 0 || (state_.incremental && (step.absolute & bit) == 0);
    const double value = component(step, i);
    end[i] = incremental ? state_.position[i] + value : value;
  }
  if (step.polar) {
    end[0] = state_.position[0];
    end[1] = state_.position[1];
    polar_point(step, end);
  }
  return true;
}

// @ and ^ from the point `point`: the distance from the origin and the angle, each the present one
// where it is not given; in G91 both are added. Always in the XY plane, as on LinuxCNC.
void Interpreter::polar_point(const Step& step, Axes& point) const {
  constexpr double kDegree = std::numbers::pi / 180.0;
  double radius = std::hypot(point[0], point[1]);
  double angle = std::atan2(point[1], point[0]);
  if (!std::isnan(step.polar_radius)) {
    radius = step.polar_radius * state_.unit_mm + (state_.incremental ? radius : 0.0);
  }
  if (!std::isnan(step.polar_angle_deg)) {
    angle = step.polar_angle_deg * kDegree + (state_.incremental ? angle : 0.0);
  }
  point[0] = radius * std::cos(angle);
  point[1] = radius * std::sin(angle);
}

bool Interpreter::has_feed(const Step& step) {
  if (state_.feed_mode == FeedMode::inverse_time) {
    if (!step.has('F')) {
      return refuse(step, 'G', "feed_missing", "an F word is needed in every cutting block of G93");
    }
    return step['F'] > 0.0 || refuse(step, 'F', "feed_missing", "a feed of zero");
  }
  if (!(state_.feed_mm_s > 0.0)) {
    return refuse(step, step.has('F') ? 'F' : 'G', "feed_missing",
                  "a cutting move, but no feed (F) is in force");
  }
  if (state_.feed_mode == FeedMode::per_revolution && state_.spindle_speed_rev_s == 0.0 &&
      state_.surface_speed_mm_s == 0.0) {
    return refuse(step, 'G', "spindle_speed_missing",
                  "feed per revolution, but no spindle speed (S) is in force");
  }
  return true;
}

bool Interpreter::straight(const Step& step) {
  const bool cutting = motion_now_ == g::kLinear;
  if (cutting && !has_feed(step)) {
    return false;
  }
  Axes end;
  if (!end_point(step, end)) {
    return false;
  }
  const PathMode mode = state_.path_mode;
  if (step.exact_stop) {
    state_.path_mode = PathMode::exact_stop;
  }
  arc_allowed_ = true;
  const MoveKind kind = cutting ? MoveKind::linear : MoveKind::rapid;
  if (cutter_->active()) {
    return compensate(step, kind, end);
  }
  emit(kind, end);
  state_.path_mode = mode;
  return true;
}

// G38.2 to G38.5: where it really ends only the machine knows. It is given as programmed; the probe
// is taken to touch there and the axes to stand 0.254 mm (after G20 0.01 in, which is the same)
// before, as in LinuxCNC's own interpreter without a machine.
bool Interpreter::probe(const Step& step) {
  constexpr double kBefore_mm = 0.254;
  if (state_.feed_mode == FeedMode::per_revolution) {
    return refuse_code(step, 'G', 38, "probe_per_revolution",
                       "probing while feed per revolution (G95) is in force");
  }
  if (!has_feed(step)) {
    return false;
  }
  Axes end;
  if (!end_point(step, end)) {
    return false;
  }
  for (std::size_t i = 3; i < end.size(); ++i) {
    if (end[i] != state_.position[i]) {
      return refuse(step, kAxisLetters[i], "probe_axis", "probing moves X, Y and Z alone");
    }
  }
  Axes start = state_.position;
  for (std::size_t i = 0; beside_ && i < start.size(); ++i) {
    start[i] += (*beside_)[i];
  }
  const double distance = std::hypot(end[0] - start[0], end[1] - start[1], end[2] - start[2]);
  const bool may_fail = motion_now_ == g::kProbe || motion_now_ == g::kProbeAway;
  if (!(distance > 0.0) && !may_fail) {
    return refuse_code(step, 'G', 38, "probe_too_short", "a probing move that goes nowhere");
  }
  emit(MoveKind::probe, end);
  parameters_->bind(state_, config_);
  parameters_->record_probe(end);
  for (std::size_t i = 0; i < 3 && distance > 0.0; ++i) {
    state_.position[i] -= kBefore_mm * (end[i] - start[i]) / distance;
  }
  return true;
}

bool Interpreter::arc_fault(const Step& step, ArcFault fault) {
  const char letter = step.has('R') ? 'R' : step.has('I') ? 'I' : step.has('J') ? 'J' : 'K';
  switch (fault) {
    case ArcFault::radius_too_small:
      return refuse(step, letter, "arc_radius_too_small",
                    "the radius does not reach from the arc's start to its end");
    case ArcFault::no_chord:
      return refuse(step, letter, "arc_without_chord",
                    "an arc by radius whose end is its start; write a full circle with I J K");
    case ArcFault::zero_radius:
      return refuse(step, letter, "arc_zero_radius", "the arc's centre lies on its start or end");
    case ArcFault::does_not_close:
      break;
  }
  return refuse(step, letter, "arc_does_not_close",
                "the arc's end lies on another radius than its start");
}

bool Interpreter::arc_centre(const Step& step, const PlaneAxes& axes, const Axes& end,
                             PlanePoint& centre) {
  constexpr std::string_view kCentreLetters = "IJK";
  const PlanePoint start{.first = state_.position[axes.first],
                         .second = state_.position[axes.second]};
  const PlanePoint stop{.first = end[axes.first], .second = end[axes.second]};
  const ArcTolerance tolerance = arc_tolerance(state_.unit_mm != 1.0);
  if (step.has('R')) {
    const auto found = centre_from_radius(start, stop, step['R'] * state_.unit_mm,
                                          motion_now_ == g::kArcClockwise, tolerance);
    if (!found) {
      return arc_fault(step, found.error());
    }
    centre = *found;
    return true;
  }
  const auto coordinate = [&](std::size_t axis, double from) {
    const char letter = kCentreLetters[axis];
    if (!step.has(letter)) {
      return from;
    }
    const std::uint32_t bit = Step::bit(letter);
    const bool absolute =
        (step.absolute & bit) != 0 || (state_.centre_absolute && (step.incremental & bit) == 0);
    return (absolute ? 0.0 : from) + step[letter] * state_.unit_mm;
  };
  if (state_.centre_absolute &&
      !(step.has(kCentreLetters[axes.first]) && step.has(kCentreLetters[axes.second]))) {
    return refuse(step, 'G', "arc_centre_missing",
                  "absolute arc centres (G90.1) need both centre words of the plane");
  }
  centre = {.first = coordinate(axes.first, start.first),
            .second = coordinate(axes.second, start.second)};
  const auto checked = check_centre(start, stop, centre, tolerance);
  return checked.has_value() || arc_fault(step, checked.error());
}

bool Interpreter::arc(const Step& step) {
  if (!has_feed(step)) {
    return false;
  }
  if (!arc_allowed_) {
    return refuse(step, 'G', "arc_after_cutter_comp",
                  "the move behind G40 must be a straight line, not an arc");
  }
  const PlaneAxes axes = axes_of(state_.plane);
  const bool by_centre = (step.mask & kCentreMask) != 0;
  if (!by_centre && !step.has('R')) {
    return refuse(step, 'G', "arc_centre_missing", "an arc without radius (R) or centre (I J K)");
  }
  if (by_centre && step.has('R')) {
    return refuse(step, 'R', "arc_centre_twice", "an arc with both radius and centre words");
  }
  const char foreign = "IJK"[axes.normal];
  if (step.has(foreign)) {
    return refuse(step, foreign, "arc_centre_off_plane",
                  "a centre word that does not belong to the arc's plane");
  }
  const double turns = step.has('P') ? step['P'] : 1.0;
  if (turns != std::floor(turns) || turns < 1.0 || turns > 1e6) {
    return refuse(step, 'P', "arc_turns", "the number of turns is a whole number from 1");
  }
  Axes end;
  PlanePoint centre;
  if (!end_point(step, end) || !arc_centre(step, axes, end, centre)) {
    return false;
  }
  move_.centre_mm = {state_.position[0], state_.position[1], state_.position[2]};
  move_.centre_mm[axes.first] = centre.first;
  move_.centre_mm[axes.second] = centre.second;
  move_.normal = {};
  move_.normal[axes.normal] = 1.0;
  move_.turns = static_cast<int>(motion_now_ == g::kArcClockwise ? -turns : turns);
  const PathMode mode = state_.path_mode;
  if (step.exact_stop) {
    state_.path_mode = PathMode::exact_stop;
  }
  const bool compensates = cutter_->active();
  const bool done = !compensates || compensate(step, MoveKind::arc, end);
  if (!compensates) {
    emit(MoveKind::arc, end);
  }
  state_.path_mode = mode;
  move_.centre_mm = {};
  move_.normal = {};
  move_.turns = 0;
  return done;
}

// By way of the given point to the reference point; only the named axes go there, all when none is.
bool Interpreter::home(const Step& step, std::size_t which) {
  const bool some = (step.mask & kAxisMask) != 0;
  Axes end;
  if (!end_point(step, end)) {
    return false;
  }
  emit(MoveKind::rapid, end);
  const Axes reference = to_work(state_.home[which]);
  for (std::size_t i = 0; i < kAxisLetters.size(); ++i) {
    if (!some || step.has(kAxisLetters[i])) {
      end[i] = reference[i] + (tool_stays(i) ? state_.tool_offset[i] : 0.0);
    }
  }
  emit(MoveKind::rapid, end);
  return true;
}

void Interpreter::fill(MoveKind kind, const Axes& end) {
  move_.kind = kind;
  move_.start = state_.position;
  move_.end = end;
  move_.offset = state_.offset;
  move_.rotation_deg = state_.rotation_in_force_deg;
  const bool cutting = kind != MoveKind::rapid;
  move_.feed_mode = state_.feed_mode;
  move_.feed_mm_s = !cutting                                  ? 0.0
                    : only_rotary_moves(state_.position, end) ? state_.feed_deg_s
                                                              : state_.feed_mm_s;
  move_.path_mode = state_.path_mode;
  move_.path_tolerance_mm = state_.path_tolerance_mm;
  move_.spindle_rev_s =
      state_.surface_speed ? 0.0 : state_.spindle_direction * state_.spindle_speed_rev_s;
  move_.surface_speed_mm_s = state_.spindle_direction * state_.surface_speed_mm_s;
  move_.spindle_limit_rev_s = state_.spindle_limit_rev_s;
  move_.override_locked = state_.override_off || kind == MoveKind::thread;
  move_.dwell_s = 0.0;
}

void Interpreter::emit(MoveKind kind, const Axes& end) {
  fill(kind, end);
  if (beside_) {
    time_by_contour();
    for (std::size_t i = 0; i < end.size(); ++i) {
      move_.start[i] += (*beside_)[i];
    }
    beside_.reset();
  }
  state_.position = end;
  sink_->on_move(move_);
  move_.machine_axes = 0;
}

void Interpreter::emit_dwell(double seconds) {
  Move dwell;
  dwell.kind = MoveKind::dwell;
  dwell.line = move_.line;
  dwell.start = state_.position;
  dwell.end = state_.position;
  dwell.offset = state_.offset;
  dwell.rotation_deg = state_.rotation_in_force_deg;
  dwell.feed_mode = state_.feed_mode;
  dwell.path_mode = state_.path_mode;
  dwell.path_tolerance_mm = state_.path_tolerance_mm;
  dwell.spindle_rev_s =
      state_.surface_speed ? 0.0 : state_.spindle_direction * state_.spindle_speed_rev_s;
  dwell.surface_speed_mm_s = state_.spindle_direction * state_.surface_speed_mm_s;
  dwell.spindle_limit_rev_s = state_.spindle_limit_rev_s;
  dwell.override_locked = state_.override_off;
  dwell.dwell_s = seconds;
  for (std::size_t i = 0; beside_ && i < dwell.end.size(); ++i) {
    dwell.start[i] += (*beside_)[i];
    dwell.end[i] = dwell.start[i];
  }
  sink_->on_move(dwell);
}

}  // namespace steadyrest::nc::interpret
