// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <array>
#include <cmath>
#include <string_view>

#include <steadyrest/kernel/units/constants.hpp>
#include <steadyrest/nc/interpret/check/block_check.hpp>
#include <steadyrest/nc/interpret/control/coordinates.hpp>
#include <steadyrest/nc/interpret/control/worded_end.hpp>
#include <steadyrest/nc/interpret/motion/motion.hpp>

// The long path. A plain G0 or G1 block, nearly every line of a long program, bypasses it through
// blocks/plain_block.cpp: change what a straight move does in both. The property test
// PlainBlock.MovesAsTheLongWayDoes keeps them equal.
namespace steadyrest::nc::interpret {
namespace {

unsigned named_axes(const Step& step) noexcept {
  unsigned axes = 0;
  for (std::size_t i = 0; i < kAxisLetters.size(); ++i) {
    axes |= step.has(kAxisLetters[i]) ? 1U << i : 0U;
  }
  return axes;
}

/// G9 applies only to its block, however the block ends.
class ExactStop {
 public:
  ExactStop(const Step& step, State& state) noexcept : mode_(state.path_mode), before_(mode_) {
    mode_ = step.exact_stop ? PathMode::exact_stop : mode_;
  }
  ExactStop(const ExactStop&) = delete;
  ExactStop& operator=(const ExactStop&) = delete;
  ~ExactStop() { mode_ = before_; }

 private:
  PathMode& mode_;
  PathMode before_;
};

}  // namespace

bool Motion::straight(const Step& step) {
  const bool cutting = step.moves_by == g::kLinear;
  if (cutting && !has_feed(step, state_, refusals_)) {
    return false;
  }
  if (!take_polar(step, state_, refusals_)) {
    return false;
  }
  const Axes end = end_point(step, control_);
  const ExactStop exact_stop(step, state_);
  cutter_.goes_straight();
  const MoveKind kind = cutting ? MoveKind::linear : MoveKind::rapid;
  if (cutter_.active()) {
    return cutter_.compensate(step, kind, end);
  }
  // Machine coordinates are valid whatever the work offset: machine_check can check such a move
  // without knowing it.
  if (step.machine_frame) {
    out_.current().machine_axes = named_axes(step);
  }
  if (corners_.concerns(step)) {
    return corners_.move(step, kind, end);
  }
  out_.move(kind, end);
  return true;
}

// G38.2 to G38.5: only the machine knows where the move really ends. It is sent as programmed; the
// probe is assumed to touch there, with the axes Config::probe_short_mm short of it.
bool Motion::probe(const Step& step) {
  if (state_.feed_mode == FeedMode::per_revolution) {
    return refusals_.g_word(step, step.moves_by, "probe_per_revolution",
                            "probing while feed per revolution (G95) is in force");
  }
  if (!has_feed(step, state_, refusals_)) {
    return false;
  }
  const Axes end = end_point(step, control_);
  for (std::size_t i = 3; i < end.size(); ++i) {
    if (end[i] != state_.position[i]) {
      return refusals_.letter(step, kAxisLetters[i], "probe_axis", "probing moves only X, Y and Z");
    }
  }
  // After G40 the probe starts off the contour.
  const Axes start = out_.place();
  const double distance = std::hypot(end[0] - start[0], end[1] - start[1], end[2] - start[2]);
  // G38.3 and G38.5 may end without a touch; the others would fail.
  const bool may_fail = step.moves_by == g::kProbe || step.moves_by == g::kProbeAway;
  if (!(distance > 0.0) && !may_fail) {
    return refusals_.g_word(step, step.moves_by, "probe_too_short",
                            "a probing move that goes nowhere");
  }
  out_.move(MoveKind::probe, end);
  parameters_.record_probe(end);
  for (std::size_t i = 0; i < 3 && distance > 0.0; ++i) {
    state_.position[i] -= control_.config.probe_short_mm * (end[i] - start[i]) / distance;
  }
  return true;
}

bool Motion::refuse_arc(const Step& step, ArcFault fault) {
  // The message shows the word that gives the centre.
  const char letter = step.has('R') ? 'R' : step.has('I') ? 'I' : step.has('J') ? 'J' : 'K';
  switch (fault) {
    case ArcFault::radius_too_small:
      return refusals_.letter(step, letter, "arc_radius_too_small",
                              "the radius does not reach from the arc's start to its end");
    case ArcFault::no_chord:
      return refusals_.letter(
          step, letter, "arc_without_chord",
          "an arc by radius whose end is its start; write a full circle with I J K");
    case ArcFault::zero_radius:
      return refusals_.letter(step, letter, "arc_zero_radius",
                              "the arc's centre lies on its start or end");
    case ArcFault::does_not_close:
      break;
  }
  return refusals_.letter(step, letter, "arc_does_not_close",
                          "the arc's start and end are at different radii from its centre");
}

bool Motion::arc_centre(const Step& step, const PlaneAxes& axes, const Axes& end,
                        PlanePoint& centre) {
  constexpr std::string_view kCentreLetters = "IJK";
  const PlanePoint start{.first = state_.position[axes.first],
                         .second = state_.position[axes.second]};
  const PlanePoint stop{.first = end[axes.first], .second = end[axes.second]};
  // In the units in force, since LinuxCNC's bounds differ between them.
  const bool inch = state_.unit_mm != 1.0;
  ArcTolerance tolerance = arc_tolerance(inch);
  const kernel::machine::Program& settings = control_.config.settings;
  const double own_mm = inch ? settings.inch_arc_tolerance_mm : settings.arc_tolerance_mm;
  tolerance.spiral_mm = own_mm > 0.0 ? own_mm : tolerance.spiral_mm;
  const TextFrame& frame = state_.text_frame;
  if (step.has('R')) {
    const double scale = frame.on ? std::abs(frame.factor[axes.first]) : 1.0;
    const auto found = centre_from_radius(start, stop, step['R'] * state_.unit_mm * scale,
                                          clockwise(step, axes), tolerance);
    if (!found) {
      return refuse_arc(step, found.error());
    }
    centre = *found;
    return true;
  }
  // I J K count from the start unless G90.1 or AC( ) says otherwise for this word.
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
  // Measured from the program's zero, an omitted centre word could mean 0 or the start.
  if (state_.centre_absolute &&
      !(step.has(kCentreLetters[axes.first]) && step.has(kCentreLetters[axes.second]))) {
    return refusals_.g_word(step, step.moves_by, "arc_centre_missing",
                            "absolute arc centres (G90.1) need both centre words of the plane");
  }
  if (frame.on) {
    std::array<double, 3> from_start{};
    for (const std::size_t axis : {axes.first, axes.second}) {
      from_start[axis] =
          step.has(kCentreLetters[axis]) ? step[kCentreLetters[axis]] * state_.unit_mm : 0.0;
    }
    from_start = frame.distance(from_start);
    centre = {.first = start.first + from_start[axes.first],
              .second = start.second + from_start[axes.second]};
  } else {
    centre = {.first = coordinate(axes.first, start.first),
              .second = coordinate(axes.second, start.second)};
  }
  const auto checked = check_centre(start, stop, centre, tolerance);
  return checked.has_value() || refuse_arc(step, checked.error());
}

// Requires exactly one way of giving the centre, in the plane in force.
bool Motion::arc_words(const Step& step, const PlaneAxes& axes) {
  const bool by_centre = (step.mask & kCentreMask) != 0;
  if (!by_centre && !step.has('R')) {
    return refusals_.g_word(step, step.moves_by, "arc_centre_missing",
                            "an arc without radius (R) or centre (I J K)");
  }
  if (by_centre && step.has('R')) {
    return refusals_.letter(step, 'R', "arc_centre_twice",
                            "an arc with both radius and centre words");
  }
  // The third centre word would lift the centre out of the plane.
  const char foreign = "IJK"[axes.normal];
  if (step.has(foreign)) {
    return refusals_.letter(step, foreign, "arc_centre_off_plane",
                            "a centre word that does not belong to the arc's plane");
  }
  const double turns = step.has('P') ? step['P'] : 1.0;
  if (turns != std::floor(turns) || turns < 1.0 || turns > 1e6) {
    return refusals_.letter(step, 'P', "arc_turns",
                            "the number of turns is not valid; allowed: whole numbers from 1");
  }
  return true;
}

// A mirror image of one axis of the plane turns the sense of an arc round.
bool Motion::clockwise(const Step& step, const PlaneAxes& axes) const noexcept {
  const TextFrame& frame = state_.text_frame;
  return (step.moves_by == g::kArcClockwise) ==
         (!frame.on || frame.keeps_sense(axes.first, axes.second));
}

// Arcs that would not be arcs any more, or whose centre words have no certain meaning.
bool Motion::worded_arc(const Step& step, const PlaneAxes& axes) {
  const TextFrame& frame = state_.text_frame;
  if (state_.polar.on && (step.mask & kCentreMask) != 0) {
    return refusals_.g_word(
        step, step.moves_by, "polar_centre",
        "an arc by its centre in polar coordinates (G16); write its radius (R)");
  }
  if (!frame.on) {
    return true;
  }
  constexpr double kSame = 1e-12;
  if (std::abs(std::abs(frame.factor[axes.first]) - std::abs(frame.factor[axes.second])) > kSame) {
    return refusals_.g_word(step, step.moves_by, "scaled_arc",
                            "an arc while its plane's axes are scaled differently");
  }
  if (frame.rotated && (axes.first != frame.first || axes.second != frame.second)) {
    return refusals_.g_word(step, step.moves_by, "arc_off_rotation",
                            "an arc outside the plane of the rotation in force");
  }
  return true;
}

bool Motion::arc(const Step& step) {
  if (!has_feed(step, state_, refusals_)) {
    return false;
  }
  if (!cutter_.arc_allowed()) {
    // After G40 the tool is off the contour: an arc from there would have another radius.
    return refusals_.g_word(step, step.moves_by, "arc_after_cutter_comp",
                            "the move after G40 is an arc; it must be a straight line");
  }
  const PlaneAxes axes = axes_of(state_.plane);
  if (!take_polar(step, state_, refusals_) || !worded_arc(step, axes)) {
    return false;
  }
  const Axes end = end_point(step, control_);
  PlanePoint centre;
  if (!arc_words(step, axes) || !arc_centre(step, axes, end, centre)) {
    return false;
  }
  Move& move = out_.current();
  // Along the normal the centre is at the start's height.
  move.centre_mm = {state_.position[0], state_.position[1], state_.position[2]};
  move.centre_mm[axes.first] = centre.first;
  move.centre_mm[axes.second] = centre.second;
  move.normal[axes.normal] = 1.0;
  const double turns = step.has('P') ? step['P'] : 1.0;
  move.turns = static_cast<int>(clockwise(step, axes) ? -turns : turns);
  const ExactStop exact_stop(step, state_);
  bool accepted = true;
  if (cutter_.active()) {
    accepted = cutter_.compensate(step, MoveKind::arc, end);
  } else if (corners_.concerns(step)) {
    accepted = corners_.move(step, MoveKind::arc, end);
  } else {
    out_.move(MoveKind::arc, end);
  }
  // The current move is reused for the next block, which may not be an arc.
  move.centre_mm = {};
  move.normal = {};
  move.turns = 0;
  return accepted;
}

// Via the given point to the reference point; only the named axes go there, all if none is named.
void Motion::home(const Step& step, std::size_t which) {
  const bool some = (step.mask & kAxisMask) != 0;
  Axes end = end_point(step, control_);
  out_.move(MoveKind::rapid, end);
  // The reference point is a machine position, so it is converted to the work coordinates in force.
  const Axes reference = to_work(state_, state_.home[which]);
  for (std::size_t i = 0; i < kAxisLetters.size(); ++i) {
    if (!some || step.has(kAxisLetters[i])) {
      end[i] = reference_of(which, i, reference[i]);
    }
  }
  out_.move(MoveKind::rapid, end);
}

// One axis of the reference point in work coordinates, from where the axis is now.
double Motion::reference_of(std::size_t which, std::size_t axis, double reference) const noexcept {
  const double end =
      reference + (tool_stays(control_.rules, axis) ? state_.tool_offset[axis] : 0.0);
  return is_wrapped(control_, axis)
             ? within_turn(state_.home[which][axis], end, state_.position[axis])
             : end;
}

// The order is LinuxCNC's: the interpreter lifts the quill and goes to G30, its task then goes to
// TOOL_CHANGE_POSITION. After G40 the moves start beside the contour, as any move does.
void Motion::to_tool_change() {
  const kernel::machine::Program& settings = control_.config.settings;
  if (!settings.tool_change_with_spindle_on) {  // M3 must start it again
    state_.spindle_direction = 0;
    out_.spindle();
  }
  if (settings.tool_change_quill_up) {
    Axes machine = to_machine(state_, state_.position);
    machine[2] = 0.0;
    Axes end = state_.position;
    end[2] = to_work(state_, machine)[2];
    out_.current().machine_axes = 1U << 2U;
    out_.move(MoveKind::rapid, end);
  }
  if (settings.tool_change_at_g30) {
    Axes end = to_work(state_, state_.home[1]);
    for (std::size_t i = 0; i < end.size(); ++i) {
      end[i] = reference_of(1, i, end[i]);
    }
    out_.move(MoveKind::rapid, end);
  }
  if (settings.tool_change_position_mm.size() == 3) {
    Axes machine = to_machine(state_, state_.position);
    std::uint32_t named = 0b111;
    std::ranges::copy(settings.tool_change_position_mm, machine.begin());
    for (std::size_t i = 0; i < settings.tool_change_rotary_rad.size(); ++i) {
      machine[3 + i] = settings.tool_change_rotary_rad[i] / kernel::units::kDegree;
      named |= 1U << (3 + i);
    }
    out_.current().machine_axes = named;
    out_.move(MoveKind::rapid, to_work(state_, machine));
  }
}

}  // namespace steadyrest::nc::interpret
