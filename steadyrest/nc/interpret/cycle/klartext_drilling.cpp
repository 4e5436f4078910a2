// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <cmath>

#include <steadyrest/nc/interpret/cycle/klartext_hole.hpp>

// The sequences of the drilling cycles, from the set-up clearance on.
namespace steadyrest::nc::interpret {
namespace {

constexpr double kMostPecks = 300'000.0;
/// What is left of a depth by rounding alone is not an infeed: 4 infeeds of 3.922 mm make 15.688
/// mm.
constexpr double kLeastInfeed_mm = 1e-6;

}  // namespace

// A feed of 0 is rapid traverse.
void KlartextCycles::along(const Hole& hole, double feed_mm_s, double height) {
  state_.feed_mm_s = feed_mm_s;
  out_.along(feed_mm_s > 0.0 ? MoveKind::linear : MoveKind::rapid, hole.normal, height);
}

void KlartextCycles::rest(double seconds) {
  if (seconds > 0.0) {
    out_.dwell(seconds);
  }
}

// Back to the clearance, then to the second one if it is higher.
void KlartextCycles::out_of_hole(const Hole& hole, double feed_mm_s) {
  if (feed_mm_s > 0.0) {
    along(hole, feed_mm_s, hole.clear_mm);
    if (hole.second_mm > hole.clear_mm) {
      along(hole, 0.0, hole.second_mm);
    }
    return;
  }
  along(hole, 0.0, hole.second_mm);
}

// Bounds the time of every program: a misplaced decimal point could ask for any number.
bool KlartextCycles::count(const Step& step, double pecks) {
  return pecks <= kMostPecks ||
         refusals_.block(step, "out_of_range", "a cycle of more than a million moves");
}

// 200: infeeds of Q202; after each back to the clearance, a dwell of Q210 there, and down to the
// clearance above the depth that has been reached.
bool KlartextCycles::drill(const Step& step, Hole& hole) {
  double infeed = 0.0;
  double in = 0.0;
  double top_s = 0.0;
  double bottom_s = 0.0;
  if (!value(step, 202, infeed) || !feed(step, 206, in) || !dwell(step, 210, top_s) ||
      !dwell(step, 211, bottom_s)) {
    return false;
  }
  const double whole = hole.surface_mm - hole.bottom_mm;
  const double one = infeed > 0.0 ? std::min(infeed * state_.unit_mm, whole) : whole;
  if (!count(step, whole / one)) {
    return false;
  }
  for (double depth = one; depth < whole - kLeastInfeed_mm; depth += one) {
    along(hole, in, hole.surface_mm - depth);
    along(hole, 0.0, hole.clear_mm);
    rest(top_s);
    along(hole, 0.0, hole.surface_mm - depth + hole.clearance_mm);
  }
  along(hole, in, hole.bottom_mm);
  rest(bottom_s);
  out_of_hole(hole, 0.0);
  return true;
}

// 240: to the depth Q201 and a dwell there; the depth by the diameter (Q343 = 1) needs the tool's
// angle.
bool KlartextCycles::centre(const Step& step, Hole& hole) {
  double in = 0.0;
  double bottom_s = 0.0;
  double by_diameter = 0.0;
  if (!value(step, 343, by_diameter) || !feed(step, 206, in) || !dwell(step, 211, bottom_s)) {
    return false;
  }
  if (by_diameter != 0.0) {
    return refusals_.block(step, "cycle_value",
                           "CYCL DEF 240 with the depth by the diameter (Q343) is not interpreted");
  }
  along(hole, in, hole.bottom_mm);
  rest(bottom_s);
  out_of_hole(hole, 0.0);
  return true;
}

// 201: in at Q206, dwell, out at Q208 (0: Q206).
bool KlartextCycles::ream(const Step& step, Hole& hole) {
  double in = 0.0;
  double bottom_s = 0.0;
  if (!feed(step, 206, in) || !dwell(step, 211, bottom_s)) {
    return false;
  }
  double written = 0.0;
  double back = in;
  if (!value(step, 208, written) || (written != 0.0 && !feed(step, 208, back))) {
    return false;
  }
  along(hole, in, hole.bottom_mm);
  rest(bottom_s);
  out_of_hole(hole, back);
  return true;
}

// 203: infeeds that shrink by Q212 down to Q205; without chip breaking (Q213 = 0) the tool leaves
// the hole after each, at Q208. What Q208 = 0 means differs between controls.
bool KlartextCycles::universal_drill(const Step& step, Hole& hole) {
  double infeed = 0.0;
  double in = 0.0;
  double top_s = 0.0;
  double bottom_s = 0.0;
  double less = 0.0;
  double least = 0.0;
  double breaks = 0.0;
  double back = 0.0;
  if (!value(step, 202, infeed) || !feed(step, 206, in) || !dwell(step, 210, top_s) ||
      !dwell(step, 211, bottom_s) || !value(step, 212, less) || !value(step, 213, breaks) ||
      !value(step, 205, least) || !feed(step, 208, back)) {
    return false;
  }
  const double unit = state_.unit_mm;
  const double whole = hole.surface_mm - hole.bottom_mm;
  double one = infeed > 0.0 ? std::min(infeed * unit, whole) : whole;
  if (breaks != 0.0 && one < whole) {
    return refusals_.block(step, "cycle_value",
                           "CYCL DEF 203 with chip breaking (Q213) is not interpreted");
  }
  const double floor = std::min(least > 0.0 ? least * unit : one, one);
  if (!(less >= 0.0) || !count(step, whole / std::max(floor, 1e-12))) {
    return less >= 0.0 ? false
                       : refusals_.block(step, "out_of_range", "a negative decrement (Q212)");
  }
  for (double depth = one; depth < whole - kLeastInfeed_mm; depth += one) {
    along(hole, in, hole.surface_mm - depth);
    along(hole, back, hole.clear_mm);
    rest(top_s);
    along(hole, 0.0, hole.surface_mm - depth + hole.clearance_mm);
    one = std::max(one - less * unit, floor);
  }
  along(hole, in, hole.bottom_mm);
  rest(bottom_s);
  out_of_hole(hole, back);
  return true;
}

// 205: as 203, but back down to the stop distance Q258 above the depth that has been reached.
bool KlartextCycles::universal_peck(const Step& step, Hole& hole) {
  double infeed = 0.0;
  double in = 0.0;
  double bottom_s = 0.0;
  double less = 0.0;
  double least = 0.0;
  double stop_above = 0.0;
  double stop_below = 0.0;
  double chips = 0.0;
  if (!value(step, 202, infeed) || !feed(step, 206, in) || !dwell(step, 211, bottom_s) ||
      !value(step, 212, less) || !value(step, 205, least) || !value(step, 258, stop_above) ||
      !value(step, 259, stop_below) || !value(step, 257, chips)) {
    return false;
  }
  double start = 0.0;
  static_cast<void>(optional(379, start));
  if (chips != 0.0 || start != 0.0 || stop_above != stop_below) {
    return refusals_.block(step, "cycle_value",
                           "CYCL DEF 205 with chip breaking (Q257), a deeper start (Q379) or two "
                           "stop distances (Q258, Q259) is not interpreted");
  }
  const double unit = state_.unit_mm;
  const double whole = hole.surface_mm - hole.bottom_mm;
  double one = infeed > 0.0 ? std::min(infeed * unit, whole) : whole;
  const double floor = std::min(least > 0.0 ? least * unit : one, one);
  if (!(less >= 0.0) || !(stop_above >= 0.0)) {
    return refusals_.block(step, "out_of_range",
                           "a negative decrement (Q212) or stop distance (Q258)");
  }
  if (!count(step, whole / std::max(floor, 1e-12))) {
    return false;
  }
  for (double depth = one; depth < whole - kLeastInfeed_mm; depth += one) {
    along(hole, in, hole.surface_mm - depth);
    along(hole, 0.0, hole.clear_mm);
    along(hole, 0.0, hole.surface_mm - depth + stop_above * unit);
    one = std::max(one - less * unit, floor);
  }
  along(hole, in, hole.bottom_mm);
  rest(bottom_s);
  out_of_hole(hole, 0.0);
  return true;
}

// 206: with a floating holder: in at Q206, reversed, a dwell, out at the same feed.
bool KlartextCycles::tap(const Step& step, Hole& hole) {
  double in = 0.0;
  double bottom_s = 0.0;
  if (!feed(step, 206, in) || !dwell(step, 211, bottom_s)) {
    return false;
  }
  const int into = state_.spindle_direction;
  if (into == 0 || !(in > 0.0)) {
    return refusals_.block(
        step, into == 0 ? "spindle_stands" : "feed_missing",
        into == 0 ? "tapping with the spindle stopped" : "tapping at rapid traverse");
  }
  // Feed and spindle must keep their ratio, so no override may act while the tap is in.
  const bool override_off = state_.override_off;
  state_.override_off = true;
  along(hole, in, hole.bottom_mm);
  state_.spindle_direction = -into;
  out_.spindle();
  rest(bottom_s);
  along(hole, in, hole.clear_mm);
  state_.spindle_direction = into;
  out_.spindle();
  state_.override_off = override_off;
  if (hole.second_mm > hole.clear_mm) {
    along(hole, 0.0, hole.second_mm);
  }
  return true;
}

// 207: the feed follows the spindle by the pitch Q239, whose sign is the thread's direction.
bool KlartextCycles::rigid_tap(const Step& step, Hole& hole) {
  double pitch = 0.0;
  if (!value(step, 239, pitch)) {
    return false;
  }
  if (pitch == 0.0 || !(state_.spindle_speed_rev_s > 0.0)) {
    return refusals_.block(step, pitch == 0.0 ? "pitch_missing" : "speed_missing",
                           pitch == 0.0 ? "CYCL DEF 207 with a pitch of zero (Q239)"
                                        : "CYCL DEF 207 without a spindle speed (S)");
  }
  const FeedMode mode = state_.feed_mode;
  state_.feed_mode = FeedMode::per_revolution;
  state_.feed_mm_s = std::abs(pitch) * state_.unit_mm;
  state_.spindle_direction = pitch > 0.0 ? 1 : -1;
  out_.spindle();
  out_.along(MoveKind::thread, hole.normal, hole.bottom_mm);
  state_.spindle_direction = -state_.spindle_direction;
  out_.spindle();
  out_.along(MoveKind::thread, hole.normal, hole.clear_mm);
  state_.feed_mode = mode;
  // It stands at the clearance; M3 starts it again.
  state_.spindle_direction = 0;
  out_.spindle();
  if (hole.second_mm > hole.clear_mm) {
    along(hole, 0.0, hole.second_mm);
  }
  return true;
}

// 1: the tool stands at the clearance above the surface. Back to there after each infeed, then down
// to t above the depth that has been reached: t = 0.6 mm up to 30 mm of depth, then depth/50, at
// most 7 mm.
bool KlartextCycles::old_peck(const Step& step) {
  const auto& parts = state_.klartext.cycle_parts;
  const double unit = state_.unit_mm;
  Hole hole;
  hole.normal = axes_of(state_.plane).normal;
  hole.clear_mm = state_.position[hole.normal];
  hole.surface_mm = hole.clear_mm - std::abs(parts[1]) * unit;
  const double whole = -parts[2] * unit;
  const double one = std::min(std::abs(parts[3]) * unit, whole);
  if (!(whole > 0.0) || !(one > 0.0) || !(parts[5] > 0.0) || !(parts[4] >= 0.0) ||
      !(whole <= 1e7) || !(std::abs(hole.surface_mm) <= 1e7)) {
    return refusals_.block(step, "cycle_planes",
                           "CYCL DEF 1 whose depth is not below 0, or without infeed, dwell or "
                           "feed");
  }
  if (!count(step, whole / one)) {
    return false;
  }
  const double feed_before = state_.feed_mm_s;
  const double in = parts[5] * (state_.unit_mm != 1.0 ? 0.1 * kMmPerInch : 1.0) / 60.0;
  constexpr double kShallow_mm = 30.0;
  const double stop = whole <= kShallow_mm ? 0.6 : std::min(whole / 50.0, 7.0);
  for (double depth = one; depth < whole - kLeastInfeed_mm; depth += one) {
    along(hole, in, hole.surface_mm - depth);
    along(hole, 0.0, hole.clear_mm);
    along(hole, 0.0, hole.surface_mm - depth + stop);
  }
  along(hole, in, hole.surface_mm - whole);
  rest(parts[4]);
  along(hole, 0.0, hole.clear_mm);
  state_.feed_mm_s = feed_before;
  return true;
}

}  // namespace steadyrest::nc::interpret
