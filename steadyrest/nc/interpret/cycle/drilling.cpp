// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <cmath>

#include <steadyrest/nc/interpret/check/block_check.hpp>
#include <steadyrest/nc/interpret/control/coordinates.hpp>
#include <steadyrest/nc/interpret/control/worded_end.hpp>
#include <steadyrest/nc/interpret/cycle/drilling.hpp>

namespace steadyrest::nc::interpret {
namespace {

constexpr std::string_view kNormalLetters = "XYZ";
/// The most moves that one block may expand to: bounds the time of every program.
constexpr double kMostMoves = 1e6;
/// G73 and G83 return to this height above the bottom of the last peck: 0.254 mm or 0.010 in.
constexpr double kPeckClearance_mm = 0.254;

double repeats_of(const Step& step) noexcept {
  return step.has('L') ? step['L'] : 1.0;
}

}  // namespace

// fanuc K0: the row's words are kept and nothing is drilled.
bool Drilling::stores_alone(const Step& step) const noexcept {
  return control_.rules.cycle_keeps_all_words && step.has('L') && step['L'] == 0.0;
}

// Sticky words: they persist while the same cycle continues from block to block.
bool Drilling::remember(const Step& step) {
  // Words are kept in the program's units. `fresh` is the first block of a cycle: LinuxCNC requires
  // the words again when another cycle begins, FANUC when a cycle follows something else.
  CycleMemory& memory = state_.cycle;
  const bool stay = control_.rules.cycle_words_stay;
  const bool fresh = stay ? !is_cycle(state_.motion) : state_.motion != step.moves_by;
  // The initial level of G98 is the level at which a row of holes began.
  if (!is_cycle(state_.motion) || memory.begins_anew) {
    memory.initial = state_.position[axes_of(state_.plane).normal] / state_.unit_mm;
    memory.begins_anew = false;
  }
  const char normal = kNormalLetters[axes_of(state_.plane).normal];
  struct Sticky {
    char letter;
    double* place;
    bool needed;
    std::string_view text;
  };
  const PlaneAxes axes = axes_of(state_.plane);
  const int code = step.moves_by;
  const bool first_peck = control_.rules.pecks_by_words && step.has('I');
  const bool pecks = code == g::kBreakChips || code == g::kPeck;
  const bool shifts = code == g::kFineBore || code == g::kBackBoreByShift;
  const bool dwells = code == g::kDrillDwell || code == g::kBoreStopOut ||
                      code == g::kBoreHandOut || code == g::kBoreDwell;
  const bool taps = code == g::kTapRight || code == g::kTapLeft;
  const bool back = code == g::kBackBore;
  // LinuxCNC keeps P from cycle to cycle, but tapping begins without a dwell; FANUC begins every
  // row of holes without one.
  if (fresh && (taps || stay)) {
    memory.dwell_s = 0.0;
  }
  if (fresh && control_.rules.pecks_by_words) {
    memory.ijk = {};
  }
  const std::array words = {
      Sticky{'R', &memory.retract, true, "a canned cycle without its retract plane (R)"},
      Sticky{normal, &memory.bottom, true, "a canned cycle without the depth of its hole"},
      Sticky{'Q', &memory.peck, (pecks || shifts) && !first_peck,
             "a cycle without the depth of its pecks, or its shift (Q)"},
      Sticky{'P', &memory.dwell_s, dwells && control_.rules.cycle_needs_dwell,
             "a cycle with a dwell, without its time (P)"},
      Sticky{"IJK"[axes.first], &memory.ijk[axes.first], back, "G87 without its shift (I J K)"},
      Sticky{"IJK"[axes.second], &memory.ijk[axes.second], back, "G87 without its shift (I J K)"},
      Sticky{"IJK"[axes.normal], &memory.ijk[axes.normal], back,
             "G87 without its upper depth (I J K)"},
  };
  for (const Sticky& word : words) {
    if (step.has(word.letter)) {
      *word.place = step[word.letter];
    } else if (word.needed && fresh) {
      return refusals_.g_word(step, code, "cycle_word_missing", word.text);
    }
  }
  if (taps && step.has('P') && step['P'] < 0.0) {
    return refusals_.letter(step, 'P', "out_of_range", "a dwell of negative time");
  }
  if (pecks && !by_words() && !(memory.peck > 0.0)) {
    return refusals_.letter(step, 'Q', "out_of_range",
                            "the depth of a peck (Q) must be above zero");
  }
  return true;
}

// Haas: the pecks are I, then J less each time, K at least; G17 alone has them so.
bool Drilling::by_words() const noexcept {
  return control_.rules.pecks_by_words && state_.cycle.ijk[0] > 0.0;
}

double Drilling::next_peck_mm(double last_mm) const noexcept {
  const double unit = state_.unit_mm;
  if (!by_words()) {
    return state_.cycle.peck * unit;
  }
  const auto& [first, less, least] = state_.cycle.ijk;
  return last_mm <= 0.0 ? first * unit : std::max(last_mm - less * unit, least * unit);
}

bool Drilling::check_peck_words(const Step& step) {
  const auto& [first, less, least] = state_.cycle.ijk;
  const bool pecks = step.moves_by == g::kBreakChips || step.moves_by == g::kPeck;
  if (!pecks || !control_.rules.pecks_by_words || (first == 0.0 && less == 0.0 && least == 0.0)) {
    return true;
  }
  // K with Q in G73 and G83 asks for a full retract every so often: not by these words alone.
  const bool whole = first > 0.0 && less >= 0.0 && least > 0.0 && state_.plane == Plane::xy;
  return whole || refusals_.g_word(step, step.moves_by, "peck_words",
                                   "pecks by I, J and K need all three, above zero, in G17");
}

bool Drilling::check(const Step& step) {
  for (const char letter : std::string_view{"ABCUVW"}) {
    if (step.has(letter)) {
      return refusals_.letter(step, letter, "axis_in_cycle",
                              "this axis cannot move in a canned cycle");
    }
  }
  if (!state_.text_frame.leaves_alone(axes_of(state_.plane).normal)) {
    return refusals_.g_word(step, step.moves_by, "frame_along_hole",
                            "a canned cycle while its holes' axis is scaled, mirrored or turned");
  }
  // In G93 each block has one time, but a cycle is many moves.
  if (state_.feed_mode == FeedMode::inverse_time) {
    return refusals_.g_word(step, step.moves_by, "cycle_in_inverse_time",
                            "a canned cycle while inverse-time feed (G93) is in force");
  }
  if (stores_alone(step)) {
    if (((step.mask & kAxisMask) & ~Step::bit(kNormalLetters[axes_of(state_.plane).normal])) != 0) {
      return refusals_.letter(step, 'L', "out_of_range",
                              "a cycle with 0 repeats and a place: whether the control goes there "
                              "is not certain; leave the place out");
    }
    return true;
  }
  if (repeats_of(step) < 1.0) {
    return refusals_.letter(step, 'L', "out_of_range", "too few repeats (L); allowed: 1 or more");
  }
  return has_feed(step, state_, refusals_);
}

// The levels of the hole from the sticky words; refused where they are in the wrong order or would
// need too many moves.
bool Drilling::measure(const Step& step, Hole& hole) {
  const CycleMemory& memory = state_.cycle;
  const double unit = state_.unit_mm;
  hole.initial_mm = memory.initial * unit;
  // In G91 R counts from the initial level and the bottom from the R plane.
  hole.retract_mm = memory.retract * unit + (state_.incremental ? hole.initial_mm : 0.0);
  hole.bottom_mm = memory.bottom * unit + (state_.incremental ? hole.retract_mm : 0.0);
  if (hole.retract_mm < hole.bottom_mm) {
    return refusals_.letter(step, step.has('R') ? 'R' : kNormalLetters[hole.axes.normal],
                            "retract_below_bottom",
                            "the retract plane (R) lies below the bottom of the hole");
  }
  // G98 returns to the initial level, but never below R; G99 to R.
  const double high = std::max(hole.initial_mm, hole.retract_mm);
  hole.clear_mm = state_.retract_to_initial ? high : hole.retract_mm;
  const double depth = hole.retract_mm - hole.bottom_mm;
  const bool pecks = step.moves_by == g::kBreakChips || step.moves_by == g::kPeck;
  // A peck is at most three moves. Without the bound a misplaced decimal point in Q could expand to
  // any number.
  const double peck_mm = by_words() ? memory.ijk[2] * unit : memory.peck * unit;
  const double moves = count_ * (pecks ? 3.0 * depth / peck_mm + 4.0 : 8.0);
  if (!(moves <= kMostMoves)) {
    return refusals_.letter(step, step.has('L') ? 'L' : 'Q', "out_of_range",
                            "a cycle of more than a million moves");
  }
  return true;
}

// Goes over the next hole at the given height, then down to the retract plane.
void Drilling::go_to(const Step& step, const Hole& hole, double height_mm) {
  Axes over = state_.position;
  if (has_worded_end(state_)) {
    const Axes end = worded_end(step, state_);
    over[hole.axes.first] = end[hole.axes.first];
    over[hole.axes.second] = end[hole.axes.second];
    over[hole.axes.normal] = height_mm;
    go_down(over, hole, height_mm);
    return;
  }
  for (const std::size_t axis : {hole.axes.first, hole.axes.second}) {
    if (step.has(kAxisLetters[axis])) {
      const double value = component(step, axis, state_);
      over[axis] = state_.incremental ? over[axis] + value : value;
    }
  }
  if (step.polar) {
    over[0] = state_.position[0];
    over[1] = state_.position[1];
    polar_point(step, state_, over);
  }
  over[hole.axes.normal] = height_mm;
  go_down(over, hole, height_mm);
}

void Drilling::go_down(const Axes& over, const Hole& hole, double height_mm) {
  out_.move(MoveKind::rapid, over);
  if (height_mm != hole.retract_mm) {
    out_.along(MoveKind::rapid, hole.axes.normal, hole.retract_mm);
  }
}

bool Drilling::cycle(const Step& step) {
  return cycle(step, {.count = repeats_of(step), .place = {}});
}

bool Drilling::cycle(const Step& step, const Pattern& pattern) {
  count_ = pattern.count;
  if (!check(step) || !remember(step) || !check_peck_words(step)) {
    return false;
  }
  if (step.moves_by == g::kBackBoreByShift) {
    return back_bore_by_shift(step, pattern);
  }
  Hole hole{.axes = axes_of(state_.plane),
            .initial_mm = 0.0,
            .retract_mm = 0.0,
            .bottom_mm = 0.0,
            .clear_mm = 0.0};
  if (!measure(step, hole)) {
    return false;
  }
  state_.motion = step.moves_by;
  if (stores_alone(step)) {
    return true;
  }
  const bool lifts = control_.rules.cycle_lifts_first;
  // LinuxCNC lifts to R before it moves across; FANUC moves across first.
  if (lifts && hole.initial_mm < hole.retract_mm) {
    out_.along(MoveKind::rapid, hole.axes.normal, hole.retract_mm);
  }
  // Cycles run on the exact path whatever G64 says: a corner rounded at R would start the hole off
  // its axis.
  const PathMode path_mode = state_.path_mode;
  state_.path_mode = PathMode::exact_path;
  // LinuxCNC first lifts to the clearance where the cycle continues without its G word.
  const bool goes_on = step.code(GGroup::motion) == kNoCode;
  double height = state_.position[hole.axes.normal];
  if (lifts) {
    height = std::max(height, goes_on ? hole.clear_mm : hole.retract_mm);
  }
  bool accepted = true;
  // The second and later holes of a block start from the previous one's clearance.
  for (double repeat = 0.0; repeat < pattern.count && accepted; repeat += 1.0) {
    if (pattern.place) {
      Axes over = state_.position;
      const PlanePoint place = pattern.place(repeat);
      over[hole.axes.first] = place.first;
      over[hole.axes.second] = place.second;
      over[hole.axes.normal] = height;
      go_down(over, hole, height);
    } else if (take_polar(step, state_, refusals_)) {
      go_to(step, hole, height);
    } else {
      accepted = false;
      break;
    }
    accepted = drill(step, hole);
    // From here on the tool is at the clearance.
    height = hole.clear_mm;
  }
  state_.path_mode = path_mode;
  return accepted;
}

// From the R plane down and back out to the clearance; the cycles differ in what they do at the
// bottom and on the way out.
bool Drilling::drill(const Step& step, const Hole& hole) {
  const std::size_t normal = hole.axes.normal;
  switch (step.moves_by) {
    case g::kBreakChips:
    case g::kPeck:
      return peck(step, hole);
    case g::kTapLeft:
    case g::kTapRight:
      return tap(step, hole);
    case g::kBoreStopOut:
    case g::kBoreHandOut:
      return bore(step, hole);
    case g::kBackBore:
      return back_bore(step, hole);
    case g::kFineBore:
      return fine_bore(step, hole);
    case g::kBoreFeedOut:
      out_.along(MoveKind::linear, normal, hole.bottom_mm);
      out_.along(MoveKind::linear, normal, hole.retract_mm);
      out_.along(MoveKind::rapid, normal, hole.clear_mm);
      return true;
    case g::kBoreDwell:
      out_.along(MoveKind::linear, normal, hole.bottom_mm);
      out_.dwell(state_.cycle.dwell_s);
      out_.along(MoveKind::linear, normal, hole.clear_mm);
      return true;
    default:  // G81, G82
      out_.along(MoveKind::linear, normal, hole.bottom_mm);
      if (step.moves_by == g::kDrillDwell) {
        out_.dwell(state_.cycle.dwell_s);
      }
      out_.along(MoveKind::rapid, normal, hole.clear_mm);
      return true;
  }
}

// G83 clears the chips by retracting to the R plane; G73 only breaks them.
bool Drilling::peck(const Step& step, const Hole& hole) {
  const std::size_t normal = hole.axes.normal;
  const double least_mm = by_words() ? state_.cycle.ijk[2] * state_.unit_mm : next_peck_mm(0.0);
  const double furthest_mm = std::max(std::abs(hole.retract_mm), std::abs(hole.bottom_mm));
  // If subtracting a peck no longer changes anything, the loop below would not end.
  if (furthest_mm - least_mm == furthest_mm) {  // there would be no end
    return refusals_.g_word(step, step.moves_by, "out_of_range",
                            "a peck this small is lost in rounding at this distance from zero");
  }
  double peck_mm = next_peck_mm(0.0);
  for (double depth = hole.retract_mm - peck_mm; depth > hole.bottom_mm; depth -= peck_mm) {
    out_.along(MoveKind::linear, normal, depth);
    if (step.moves_by == g::kPeck) {
      out_.along(MoveKind::rapid, normal, hole.retract_mm);
    }
    out_.along(MoveKind::rapid, normal, depth + kPeckClearance_mm);
    peck_mm = next_peck_mm(peck_mm);
  }
  out_.along(MoveKind::linear, normal, hole.bottom_mm);
  // FANUC and Haas wait at the bottom where P is given; LinuxCNC has no P here.
  if (control_.rules.cycle_keeps_all_words && state_.cycle.dwell_s > 0.0) {
    out_.dwell(state_.cycle.dwell_s);
  }
  out_.along(MoveKind::rapid, normal, hole.clear_mm);
  return true;
}

// In at feed, reverse, dwell, out at feed. The programmed F and S make the pitch: nothing else
// couples them, as with a floating holder.
bool Drilling::tap(const Step& step, const Hole& hole) {
  const int into = step.moves_by == g::kTapRight ? 1 : -1;
  const bool rigid = state_.rigid_tap || control_.rules.taps_rigidly;
  if (rigid && !(state_.spindle_speed_rev_s > 0.0)) {
    return refusals_.g_word(step, step.moves_by, "spindle_speed_missing",
                            "rigid tapping, but no spindle speed (S) is in force");
  }
  if (!rigid && state_.spindle_direction != into) {
    return refusals_.g_word(step, step.moves_by, "spindle_direction",
                            into > 0 ? "right-hand tapping needs the spindle turning clockwise (M3)"
                                     : "left-hand tapping needs the spindle turning "
                                       "counter-clockwise (M4)");
  }
  const std::size_t normal = hole.axes.normal;
  if (control_.rules.taps_in_xy_alone && state_.plane != Plane::xy) {
    return refusals_.g_word(step, step.moves_by, "tapping_off_xy",
                            "tapping outside G17: LinuxCNC 2.9 moves the wrong axes");
  }
  // Feed and spindle must keep their ratio, so no override may act while the tap is in.
  const bool override_off = state_.override_off;
  state_.override_off = true;
  if (rigid) {
    state_.spindle_direction = into;
    out_.spindle();
  }
  out_.along(MoveKind::linear, normal, hole.bottom_mm);
  state_.spindle_direction = -into;
  out_.spindle();
  out_.dwell(state_.cycle.dwell_s);
  // Haas: J is how many times as fast the tap comes out (setting 130 without it: as fast).
  const double feed_mm_s = state_.feed_mm_s;
  const double faster = control_.rules.taps_rigidly ? state_.cycle.ijk[1] : 0.0;
  state_.feed_mm_s *= faster > 0.0 ? faster : 1.0;
  out_.along(MoveKind::linear, normal, hole.clear_mm);
  state_.feed_mm_s = feed_mm_s;
  state_.spindle_direction = rigid ? 0 : into;
  out_.spindle();
  state_.override_off = override_off;
  return true;
}

}  // namespace steadyrest::nc::interpret
