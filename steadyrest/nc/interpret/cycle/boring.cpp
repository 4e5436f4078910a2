// SPDX-License-Identifier: Apache-2.0
#include <algorithm>

#include <steadyrest/nc/interpret/control/coordinates.hpp>
#include <steadyrest/nc/interpret/control/worded_end.hpp>
#include <steadyrest/nc/interpret/cycle/drilling.hpp>

// The cycles that stop the spindle in the hole.
namespace steadyrest::nc::interpret {

// G86: out with the spindle stopped. G88: the operator brings the tool out by hand.
bool Drilling::bore(const Step& step, const Hole& hole) {
  const int direction = state_.spindle_direction;
  if (direction == 0) {
    return refusals_.g_word(step, step.moves_by, "spindle_stands",
                            "a boring cycle with the spindle stopped");
  }
  out_.along(MoveKind::linear, hole.axes.normal, hole.bottom_mm);
  out_.dwell(state_.cycle.dwell_s);
  state_.spindle_direction = 0;
  out_.spindle();
  if (step.moves_by == g::kBoreHandOut) {
    out_.event(EventKind::stop, 0.0);
    // The interpreter continues from the clearance, where the operator is asked to bring the tool.
    state_.position[hole.axes.normal] = hole.clear_mm;  // by hand: not a move of the program
  } else {
    out_.along(MoveKind::rapid, hole.axes.normal, hole.clear_mm);
  }
  state_.spindle_direction = direction;
  out_.spindle();
  return true;
}

// G87: in beside the axis with the spindle stopped, then boring upwards from below.
bool Drilling::back_bore(const Step& step, const Hole& hole) {
  const int direction = state_.spindle_direction;
  if (direction == 0) {
    return refusals_.g_word(step, g::kBackBore, "spindle_stands",
                            "a boring cycle with the spindle stopped");
  }
  const CycleMemory& memory = state_.cycle;
  const double unit = state_.unit_mm;
  const PlaneAxes axes = hole.axes;
  const double upper = memory.ijk[axes.normal] * unit + (state_.incremental ? hole.bottom_mm : 0.0);
  // Aside by I and J, down with the spindle stopped so that the bar passes, back onto the axis
  // below; only then does the spindle start.
  const Axes above = state_.position;
  Axes beside = above;
  beside[axes.first] += memory.ijk[axes.first] * unit;
  beside[axes.second] += memory.ijk[axes.second] * unit;
  out_.move(MoveKind::rapid, beside);
  state_.spindle_direction = 0;
  out_.spindle();
  out_.along(MoveKind::rapid, axes.normal, hole.bottom_mm);
  out_.back_over(above, axes.normal, hole.bottom_mm, direction);
  // Up to cut, down again to clear the shoulder; then aside and out the way it came.
  out_.along(MoveKind::linear, axes.normal, upper);
  out_.along(MoveKind::linear, axes.normal, hole.bottom_mm);
  state_.spindle_direction = 0;
  out_.spindle();
  beside[axes.normal] = hole.bottom_mm;
  out_.move(MoveKind::rapid, beside);
  out_.along(MoveKind::rapid, axes.normal, hole.clear_mm);
  out_.back_over(above, axes.normal, hole.clear_mm, direction);
  return true;
}

// Where the oriented tool goes to be off the wall: by I and J (Haas), else by Q along a direction
// that a setting of the control chooses (FANUC parameter 5148, Haas setting 27).
Axes Drilling::beside_wall(const Step& step, const PlaneAxes& axes) {
  const CycleMemory& memory = state_.cycle;
  Axes beside = state_.position;
  const bool by_vector = control_.rules.pecks_by_words &&
                         (memory.ijk[axes.first] != 0.0 || memory.ijk[axes.second] != 0.0);
  if (by_vector) {
    beside[axes.first] += memory.ijk[axes.first] * state_.unit_mm;
    beside[axes.second] += memory.ijk[axes.second] * state_.unit_mm;
  } else {
    assumptions_.note_shift(step.line);
    beside[axes.first] += memory.peck * state_.unit_mm;
  }
  return beside;
}

// G76: in at feed, dwell, off the wall with the spindle oriented, out, and back over the hole.
bool Drilling::fine_bore(const Step& step, const Hole& hole) {
  const int direction = state_.spindle_direction;
  if (direction == 0) {
    return refusals_.g_word(step, g::kThreadCycle, "spindle_stands",
                            "a boring cycle with the spindle stopped");
  }
  const Axes above = state_.position;
  const std::size_t normal = hole.axes.normal;
  out_.along(MoveKind::linear, normal, hole.bottom_mm);
  out_.dwell(state_.cycle.dwell_s);
  state_.spindle_direction = 0;
  out_.spindle();
  out_.move(MoveKind::rapid, beside_wall(step, hole.axes));
  out_.along(MoveKind::rapid, normal, hole.clear_mm);
  out_.back_over(above, normal, hole.clear_mm, direction);
  return true;
}

// G87 of FANUC and Haas: R lies below the bore and Z above it. In beside the axis with the spindle
// oriented, onto it at R, up at feed to Z, beside it again and out to the initial level (never to
// R).
bool Drilling::back_bore_by_shift(const Step& step, const Pattern& pattern) {
  if (pattern.place || stores_alone(step)) {
    return refusals_.g_word(step, g::kBackBore, "cycle_words",
                            "back boring (G87) in a pattern of holes, or with 0 repeats");
  }
  const int direction = state_.spindle_direction;
  if (direction == 0 || pattern.count > 1e5) {
    return refusals_.g_word(step, g::kBackBore, "spindle_stands",
                            "a boring cycle with the spindle stopped");
  }
  const CycleMemory& memory = state_.cycle;
  const PlaneAxes axes = axes_of(state_.plane);
  const double unit = state_.unit_mm;
  const double initial = memory.initial * unit;
  const double below = memory.retract * unit + (state_.incremental ? initial : 0.0);
  const double upper = memory.bottom * unit + (state_.incremental ? below : 0.0);
  if (!(below <= upper && upper <= initial)) {
    return refusals_.g_word(step, g::kBackBore, "retract_below_bottom",
                            "back boring (G87) goes in to R, which lies below Z, and Z below where "
                            "the cycle began");
  }
  state_.motion = step.moves_by;
  const PathMode path_mode = state_.path_mode;
  state_.path_mode = PathMode::exact_path;
  bool accepted = true;
  for (double repeat = 0.0; repeat < pattern.count && accepted; repeat += 1.0) {
    accepted = take_polar(step, state_, refusals_);
    if (accepted) {
      bore_upwards(step, axes, {below, upper, initial});
    }
  }
  state_.path_mode = path_mode;
  return accepted;
}

void Drilling::bore_upwards(const Step& step, const PlaneAxes& axes, const Levels& levels) {
  const int direction = state_.spindle_direction;
  const Axes end = end_point(step, control_);
  Axes over = state_.position;
  over[axes.first] = end[axes.first];
  over[axes.second] = end[axes.second];
  out_.move(MoveKind::rapid, over);
  state_.spindle_direction = 0;
  out_.spindle();
  out_.move(MoveKind::rapid, beside_wall(step, axes));
  out_.along(MoveKind::rapid, axes.normal, levels.below_mm);
  out_.back_over(over, axes.normal, levels.below_mm, direction);
  out_.along(MoveKind::linear, axes.normal, levels.upper_mm);
  out_.dwell(state_.cycle.dwell_s);
  state_.spindle_direction = 0;
  out_.spindle();
  out_.move(MoveKind::rapid, beside_wall(step, axes));
  out_.along(MoveKind::rapid, axes.normal, levels.initial_mm);
  out_.back_over(over, axes.normal, levels.initial_mm, direction);
}

}  // namespace steadyrest::nc::interpret
