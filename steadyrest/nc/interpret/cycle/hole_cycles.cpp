// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <cmath>

#include <steadyrest/nc/interpret/cycle/call_values.hpp>

// Deep holes, boring and tapping with a compensating chuck, as the manual "Cycles" (840D, 840D sl)
// orders their moves.
namespace steadyrest::nc::interpret {

using read::Flow;

/// What CYCLE83 has more than the planes: (…, FDEP, FDPR, DAM, DTB, DTS, FRF, VARI, _AXN, _MDEP,
/// _VRT, _DTD, _DIS1).
struct CycleCalls::Deep {
  double first_mm = 0.0;       ///< the first depth
  double degression_mm = 0.0;  ///< DAM: each stroke is so much shorter
  double dwell_s = 0.0;        ///< DTB: at each depth
  double dwell_above_s = 0.0;  ///< DTS: at the start, chips out
  double dwell_end_s = 0.0;    ///< _DTD: at the last depth
  double feed_ratio = 1.0;     ///< FRF: of the first stroke
  bool chips_out = false;      ///< VARI
  double back_mm = 1.0;        ///< _VRT: chip breaking
  double short_mm = 0.6;       ///< _DIS1: a rapid ends so far above the last depth
};

bool CycleCalls::read_deep(const Flow& call, const Hole& hole, Deep& deep) {
  const double unit = state_.unit_mm;
  const double relative = hole.reference_mm - std::abs(value(call, 6)) * unit;
  const bool absolute = given(call, 5) && value(call, 6) == 0.0;
  deep.first_mm = absolute ? value(call, 5) * unit : relative;
  if (!given(call, 5) && !given(call, 6)) {
    return refuse(call, "cycle_word_missing", "CYCLE83 without its first depth (FDEP or FDPR)");
  }
  if (given(call, 5) && !absolute && std::abs(relative - value(call, 5) * unit) > 1e-6) {
    return refuse(call, "cycle_depth", "a first depth given twice, differently (FDEP and FDPR)");
  }
  if (deep.first_mm < hole.bottom_mm || deep.first_mm >= hole.reference_mm) {
    return refuse(call, "cycle_planes",
                  "the first depth of CYCLE83 is not between the reference plane and the depth");
  }
  deep.degression_mm = value(call, 7) * unit;
  deep.dwell_s = value(call, 8);
  deep.dwell_above_s = value(call, 9);
  deep.dwell_end_s = value(call, 15) == 0.0 ? deep.dwell_s : value(call, 15);
  deep.feed_ratio = value(call, 10) == 0.0 ? 1.0 : value(call, 10);
  deep.chips_out = value(call, 11) == 1.0;
  deep.back_mm = value(call, 14) == 0.0 ? 1.0 : value(call, 14) * unit;
  const double depth = hole.reference_mm - hole.bottom_mm;
  // The manual: 0.6 mm for holes up to 30 mm, from there on a fiftieth of the depth, at most 7 mm.
  constexpr double kShallow_mm = 30.0;
  deep.short_mm = value(call, 16) > 0.0  ? value(call, 16) * unit
                  : depth <= kShallow_mm ? 0.6
                                         : std::min(depth / 50.0, 7.0);
  const double axis = value(call, 12);
  const double variant = value(call, 11);
  if (deep.degression_mm < 0.0 || deep.dwell_above_s < 0.0 || deep.dwell_end_s < 0.0 ||
      !(deep.feed_ratio > 0.0 && deep.feed_ratio <= 1.0) || (variant != 0.0 && variant != 1.0) ||
      (axis != 0.0 && axis != static_cast<double>(hole.normal + 1)) || deep.back_mm < 0.0 ||
      value(call, 16) < 0.0) {
    return refuse(call, "cycle_value",
                  "a value of CYCLE83 that is not interpreted: a factor for DAM, dwells in "
                  "revolutions, FRF beyond 0 to 1, VARI beyond 0 and 1, another axis");
  }
  // Bounds the time of every program.
  constexpr double kMostStrokes = 1e5;
  const double least = deep.degression_mm > 0.0
                           ? std::min(deep.degression_mm, hole.reference_mm - deep.first_mm)
                           : hole.reference_mm - deep.first_mm;
  return depth <= kMostStrokes * least ||
         refuse(call, "out_of_range", "a cycle of more than a hundred thousand strokes");
}

// The first stroke goes to the first depth. Each further one is shorter by DAM, but not shorter
// than DAM; the rest, once it is at most twice DAM, is shared by the last two. With DAM 0 all are
// alike.
bool CycleCalls::drill_deep(const Flow& call, const Hole& hole) {
  Deep deep;
  if (!read_deep(call, hole, deep)) {
    return false;
  }
  const auto wait = [&](double seconds) {
    if (seconds > 0.0) {
      out_.dwell(seconds);
    }
  };
  out_.along(MoveKind::rapid, hole.normal, hole.start_mm);
  const double feed = state_.feed_mm_s;
  state_.feed_mm_s = feed * deep.feed_ratio;
  out_.along(MoveKind::linear, hole.normal, deep.first_mm);
  state_.feed_mm_s = feed;
  double depth = deep.first_mm;
  double stroke = hole.reference_mm - deep.first_mm;
  const double least = deep.degression_mm;
  bool last_but_one = false;
  while (depth > hole.bottom_mm) {
    wait(deep.dwell_s);
    if (deep.chips_out) {
      out_.along(MoveKind::rapid, hole.normal, hole.start_mm);
      wait(deep.dwell_above_s);
      out_.along(MoveKind::rapid, hole.normal, std::min(hole.start_mm, depth + deep.short_mm));
    } else {
      out_.along(MoveKind::linear, hole.normal, depth + deep.back_mm);
    }
    const double rest = depth - hole.bottom_mm;
    stroke = least > 0.0 ? std::max(stroke - least, std::min(stroke, least)) : stroke;
    const bool shared = least > 0.0 && rest > least && rest <= 2.0 * least && !last_but_one;
    const double next = shared ? 0.5 * rest : std::min(stroke, rest);
    // The last stroke ends at the depth itself, whatever the sum of the strokes is.
    depth = last_but_one || next >= rest ? hole.bottom_mm : depth - next;
    last_but_one = shared;
    out_.along(MoveKind::linear, hole.normal, depth);
  }
  wait(deep.dwell_end_s);
  out_.along(MoveKind::rapid, hole.normal, hole.retract_mm);
  return true;
}

// CYCLE87 (…, SDIR), CYCLE88 (…, DTB, SDIR): out by NC start, with the spindle stopped.
void CycleCalls::bore_by_hand(const Flow& call, const Known& known, const Hole& hole) {
  out_.along(MoveKind::rapid, hole.normal, hole.start_mm);
  const double direction = value(call, known.values - 1);
  if (direction == 3.0 || direction == 4.0) {
    state_.spindle_direction = direction == 4.0 ? -1 : 1;
    out_.spindle();
  }
  out_.along(MoveKind::linear, hole.normal, hole.bottom_mm);
  if (known.dwell != 0 && value(call, known.dwell) > 0.0) {
    out_.dwell(value(call, known.dwell));
  }
  state_.spindle_direction = 0;
  out_.spindle();
  out_.event(EventKind::stop, 0.0);
  out_.along(MoveKind::rapid, hole.normal, hole.retract_mm);
}

// CYCLE89 (…, DTB): out at the feed of the way in.
void CycleCalls::bore_back(const Flow& call, const Hole& hole) {
  out_.along(MoveKind::rapid, hole.normal, hole.start_mm);
  out_.along(MoveKind::linear, hole.normal, hole.bottom_mm);
  if (value(call, kDtb) > 0.0) {
    out_.dwell(value(call, kDtb));
  }
  out_.along(MoveKind::linear, hole.normal, hole.start_mm);
  out_.along(MoveKind::rapid, hole.normal, hole.retract_mm);
}

// CYCLE840 (…, DTB, SDR, SDAC, ENC, MPIT, PIT): the feed follows the spindle by the pitch; the
// dwell counts only without an encoder (ENC 1).
bool CycleCalls::tap_floating(const Flow& call, const Hole& hole) {
  const double back = value(call, 6);
  const double after = value(call, 7);
  const double size = value(call, 9);
  const double pitch =
      size != 0.0 ? coarse_pitch(std::abs(size)) : std::abs(value(call, 10)) * state_.unit_mm;
  if (!(pitch > 0.0) || (size != 0.0 && value(call, 10) != 0.0)) {
    return refuse(call, "pitch_missing",
                  "CYCLE840 without its pitch: a size M3 to M48 (MPIT) or the pitch (PIT)");
  }
  if (!(state_.spindle_speed_rev_s > 0.0) || state_.spindle_direction == 0) {
    return refuse(call, "speed_missing",
                  "CYCLE840, but the spindle does not turn (S with M3 or M4)");
  }
  if ((back != 0.0 && back != 3.0 && back != 4.0) ||
      (back != 0.0 && after != 3.0 && after != 4.0 && after != 5.0)) {
    return refuse(call, "bad_value",
                  "CYCLE840 without how the spindle turns on the way out and after it (SDR, SDAC)");
  }
  out_.along(MoveKind::rapid, hole.normal, hole.start_mm);
  const int in = state_.spindle_direction;
  const FeedMode mode = state_.feed_mode;
  const double feed = state_.feed_mm_s;
  state_.feed_mode = FeedMode::per_revolution;
  state_.feed_mm_s = pitch;
  out_.along(MoveKind::thread, hole.normal, hole.bottom_mm);
  if (value(call, 8) == 1.0 && value(call, kDtb) > 0.0) {
    out_.dwell(value(call, kDtb));
  }
  state_.spindle_direction = back == 0.0 ? -in : back == 4.0 ? -1 : 1;
  out_.spindle();
  out_.along(MoveKind::thread, hole.normal, hole.start_mm);
  state_.feed_mode = mode;
  state_.feed_mm_s = feed;
  state_.spindle_direction = back == 0.0 ? in : after == 5.0 ? 0 : after == 4.0 ? -1 : 1;
  out_.spindle();
  out_.along(MoveKind::rapid, hole.normal, hole.retract_mm);
  return true;
}

}  // namespace steadyrest::nc::interpret
