// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <array>
#include <cmath>

#include <steadyrest/nc/interpret/cycle/call_values.hpp>
#include <steadyrest/nc/read/sinumerik/sinumerik_names.hpp>

namespace steadyrest::nc::interpret {

using read::Flow;

const CycleCalls::Known* CycleCalls::find(const Flow& call) noexcept {
  static constexpr std::array kKnown = {
      Known{.name = "CYCLE81", .kind = Kind::drill, .values = 6, .modes = 6, .dwell = kDtb},
      Known{.name = "CYCLE82", .kind = Kind::drill, .values = 6, .modes = 6, .dwell = kDtb},
      Known{.name = "CYCLE83", .kind = Kind::drill_deep, .values = 17, .modes = 17, .dwell = 8},
      Known{.name = "CYCLE84", .kind = Kind::tap, .values = 12, .modes = 0, .dwell = kDtb},
      Known{.name = "CYCLE85", .kind = Kind::ream, .values = 8, .modes = 8, .dwell = kDtb},
      Known{.name = "CYCLE86", .kind = Kind::bore, .values = 11, .modes = 11, .dwell = kDtb},
      Known{.name = "CYCLE87", .kind = Kind::bore_by_hand, .values = 6, .modes = 0, .dwell = 0},
      Known{.name = "CYCLE88", .kind = Kind::bore_by_hand, .values = 7, .modes = 0, .dwell = kDtb},
      Known{.name = "CYCLE89", .kind = Kind::bore_back, .values = 6, .modes = 6, .dwell = kDtb},
      Known{
          .name = "CYCLE840", .kind = Kind::tap_floating, .values = 11, .modes = 0, .dwell = kDtb},
      Known{.name = "HOLES1", .kind = Kind::row, .values = 6, .modes = 0, .dwell = 0},
      Known{.name = "HOLES2", .kind = Kind::circle, .values = 6, .modes = 0, .dwell = 0},
      Known{.name = "CYCLE832", .kind = Kind::tolerance, .values = 3, .modes = 0, .dwell = 0},
      Known{.name = "CYCLE800", .kind = Kind::swivel, .values = 0, .modes = 0, .dwell = 0},
  };
  const auto* const found = std::ranges::find_if(
      kKnown, [&](const Known& one) { return read::equal(call.label.view(), one.name); });
  return found == kKnown.end() ? nullptr : found;
}

// MPIT is the nominal size.
double coarse_pitch(double size) noexcept {
  constexpr std::array<std::array<double, 2>, 21> kPitches = {{
      {3, 0.5},  {4, 0.7},  {5, 0.8},  {6, 1},    {8, 1.25}, {10, 1.5}, {12, 1.75},
      {14, 2},   {16, 2},   {18, 2.5}, {20, 2.5}, {22, 2.5}, {24, 3},   {27, 3},
      {30, 3.5}, {33, 3.5}, {36, 4},   {39, 4},   {42, 4.5}, {45, 4.5}, {48, 5},
  }};
  const auto* const found =
      std::ranges::find_if(kPitches, [&](const auto& one) { return one[0] == size; });
  return found == kPitches.end() ? 0.0 : (*found)[1];
}

bool CycleCalls::refuse(const Flow& call, std::string_view reason, std::string_view text) {
  return refusals_.call(out_.line(), call, reason, text);
}

bool CycleCalls::call(const Flow& call) {
  const bool modal = call.kind == read::FlowKind::modal_cycle;
  if (modal) {
    modal_.reset();
    if (call.label.view().empty()) {
      return true;  // MCALL without a name ends the modal call
    }
  }
  const Known* const known = find(call);
  if (known == nullptr) {
    return refuse(
        call, "cycle_not_interpreted",
        "a cycle that is not interpreted; CYCLE81 to 89, 832, 840, HOLES1 and HOLES2 are");
  }
  if (!modal) {
    return run(call, *known);
  }
  if (known->kind >= Kind::row) {
    return refuse(call, "modal_call", "a modal call (MCALL) of a cycle that drills no hole");
  }
  // The planes are checked at once, so a fault is reported in its own line, not at the first hole.
  Hole hole;
  if (!newer_values(call, *known) || !planes(call, *known, hole)) {
    return false;
  }
  modal_ = call;
  return true;
}

// The interpreter calls this after every block that moves an axis.
bool CycleCalls::after_move() {
  return !modal_ || drill(*modal_, *find(*modal_));
}

bool CycleCalls::run(const Flow& call, const Known& known) {
  switch (known.kind) {
    case Kind::row:
      return newer_values(call, known) && row(call);
    case Kind::circle:
      return newer_values(call, known) && circle(call);
    case Kind::tolerance:
      return newer_values(call, known) && tolerance(call);
    case Kind::swivel:  // without values it switches swivelling off, and none can be on
      return call.count == 0 ||
             refuse(call, "transformation", "swivelling (CYCLE800) is not interpreted");
    case Kind::drill:
    case Kind::drill_deep:
    case Kind::tap:
    case Kind::ream:
    case Kind::bore:
    case Kind::bore_by_hand:
    case Kind::bore_back:
    case Kind::tap_floating:
      break;
  }
  return drill(call, known);
}

// Values of newer versions change the meaning of the others; 0 is the meaning of the older ones.
bool CycleCalls::newer_values(const Flow& call, const Known& known) {
  for (std::size_t i = known.values; i < call.count; ++i) {
    const bool mode = known.modes != 0 && i >= known.modes && i < known.modes + 3;
    if (!mode && value(call, i) != 0.0) {
      return refuse(call, "cycle_value",
                    "a value that only newer versions of the cycle have; leave it out");
    }
  }
  for (std::size_t i = 0; i < call.count; ++i) {
    if (!(std::abs(value(call, i)) <= 1e7)) {
      return refuse(call, "out_of_range",
                    "a value too large for any machine; allowed: up to 10000000 in magnitude");
    }
  }
  return known.modes == 0 || modes(call, known);
}

// _GMODE must be 0. _DMODE: 1 to 3 for G17 to G19, which must be in force. _AMODE, from the last
// digit: the depth is incremental (1) or absolute (2); dwells are in seconds (1), three of them in
// CYCLE83, whose fifth digit is for the first depth as the first one is for the last.
bool CycleCalls::modes(const Flow& call, const Known& known) {
  const double plane = value(call, known.modes + 1);
  const double now = state_.plane == Plane::xy ? 1.0 : state_.plane == Plane::zx ? 2.0 : 3.0;
  const double written = value(call, known.modes + 2);
  bool fits = value(call, known.modes) == 0.0 && (plane == 0.0 || plane == now) && written >= 0.0 &&
              written == std::floor(written);
  auto digits = fits ? static_cast<unsigned>(written) : 0U;
  const bool deep = known.kind == Kind::drill_deep;
  const auto depth = [&](unsigned digit, std::size_t absolute) {
    return digit == 0 || (digit == 1 && !given(call, absolute)) ||
           (digit == 2 && given(call, absolute) && value(call, absolute + 1) == 0.0);
  };
  fits = fits && depth(digits % 10, kDp);
  digits /= 10;
  for (std::size_t i = 0; i < (deep ? 3U : 1U); ++i) {
    fits = fits && digits % 10 <= 1;
    digits /= 10;
  }
  if (deep) {
    constexpr std::size_t kFirstDepth = 5;
    fits = fits && depth(digits % 10, kFirstDepth);
    digits /= 10;
  }
  return (fits && digits == 0) ||
         refuse(call, "cycle_value",
                "a value that only newer versions of the cycle have (_GMODE, _DMODE, _AMODE) and "
                "that is not interpreted");
}

// The planes common to all cycles: retraction, reference and safety clearance, depth.
bool CycleCalls::planes(const Flow& call, const Known& known, Hole& hole) {
  const double dwell = known.dwell == 0 ? 0.0 : value(call, known.dwell);
  if (!(dwell >= 0.0 && dwell <= 1e6)) {
    return refuse(call, "out_of_range",
                  "a dwell in revolutions (negative) or of more than 1000000 s");
  }
  if (!given(call, kRtp) || !given(call, kRfp) || (!given(call, kDp) && !given(call, kDpr))) {
    return refuse(call, "cycle_word_missing",
                  "a cycle without its retraction plane, reference plane or depth");
  }
  const double unit = state_.unit_mm;
  // DP is absolute; DPR is measured from the reference plane, regardless of sign. Both are allowed
  // if they agree.
  const double reference = value(call, kRfp);
  const double relative = reference - std::abs(value(call, kDpr));
  const bool absolute = given(call, kDp) && value(call, kDpr) == 0.0;
  if (given(call, kDp) && !absolute && std::abs(relative - value(call, kDp)) > 1e-6) {
    return refuse(call, "cycle_depth", "a depth given twice, differently (DP and DPR)");
  }
  // Planes are in the units in force at the call, moves always in mm.
  hole.normal = axes_of(state_.plane).normal;
  hole.reference_mm = reference * unit;
  hole.start_mm = (reference + std::abs(value(call, kSdis))) * unit;
  hole.bottom_mm = (absolute ? value(call, kDp) : relative) * unit;
  hole.retract_mm = value(call, kRtp) * unit;
  constexpr double kLargest = 1e7;
  for (const double height : {hole.start_mm, hole.bottom_mm, hole.retract_mm}) {
    if (!(std::abs(height) <= kLargest)) {
      return refuse(call, "out_of_range",
                    "a value too large for any machine; allowed: up to 10000000 in magnitude");
    }
  }
  // Bottom < reference plane plus clearance ≤ retraction plane: only drilling downwards is defined.
  return (hole.bottom_mm < hole.start_mm && hole.start_mm <= hole.retract_mm) ||
         refuse(call, "cycle_planes",
                "the planes of a cycle are not in order: retraction plane, reference plane "
                "and safety clearance, depth");
}

// The tapping cycles and CYCLE85 have feeds of their own.
bool CycleCalls::may_drill(const Flow& call, const Known& known) {
  const bool own_feed =
      known.kind == Kind::tap || known.kind == Kind::ream || known.kind == Kind::tap_floating;
  if (!own_feed && !(state_.feed_mm_s > 0.0)) {
    return refuse(call, "feed_missing", "a drilling cycle, but no feed (F) is in force");
  }
  if (state_.feed_mode == FeedMode::inverse_time) {
    return refuse(call, "cycle_in_inverse_time",
                  "a drilling cycle while inverse-time feed (G93) is in force");
  }
  return known.kind != Kind::ream || (value(call, 6) > 0.0 && value(call, 7) > 0.0) ||
         refuse(call, "feed_missing", "CYCLE85 without its feeds (FFR, RFF)");
}

// Every cycle begins with a rapid to the reference plane plus clearance.
bool CycleCalls::drill(const Flow& call, const Known& known) {
  Hole hole;
  if (!newer_values(call, known) || !planes(call, known, hole) || !may_drill(call, known)) {
    return false;
  }
  switch (known.kind) {
    case Kind::drill_deep:
      return drill_deep(call, hole);
    case Kind::tap_floating:
      return tap_floating(call, hole);
    case Kind::tap:
      out_.along(MoveKind::rapid, hole.normal, hole.start_mm);
      return tap(call, hole);
    case Kind::ream:
      out_.along(MoveKind::rapid, hole.normal, hole.start_mm);
      ream(call, hole);
      return true;
    case Kind::bore:
      out_.along(MoveKind::rapid, hole.normal, hole.start_mm);
      bore(call, hole);
      return true;
    case Kind::bore_by_hand:
      bore_by_hand(call, known, hole);
      return true;
    case Kind::bore_back:
      bore_back(call, hole);
      return true;
    case Kind::drill:
    case Kind::row:
    case Kind::circle:
    case Kind::tolerance:
    case Kind::swivel:
      break;
  }
  out_.along(MoveKind::rapid, hole.normal, hole.start_mm);
  out_.along(MoveKind::linear, hole.normal, hole.bottom_mm);
  if (value(call, kDtb) > 0.0) {
    out_.dwell(value(call, kDtb));
  }
  out_.along(MoveKind::rapid, hole.normal, hole.retract_mm);
  return true;
}

// (RTP, RFP, SDIS, DP, DPR, DTB, FFR, RFF): in and out at separate feeds.
void CycleCalls::ream(const Flow& call, const Hole& hole) {
  // FFR and RFF are feeds in the program's unit, so convert them like an F word.
  const double feed = state_.feed_mm_s;
  const double scale =
      state_.feed_unit_mm / (state_.feed_mode == FeedMode::per_minute ? 60.0 : 1.0);
  state_.feed_mm_s = value(call, 6) * scale;
  out_.along(MoveKind::linear, hole.normal, hole.bottom_mm);
  if (value(call, kDtb) > 0.0) {
    out_.dwell(value(call, kDtb));
  }
  state_.feed_mm_s = value(call, 7) * scale;
  out_.along(MoveKind::linear, hole.normal, hole.start_mm);
  state_.feed_mm_s = feed;
  out_.along(MoveKind::rapid, hole.normal, hole.retract_mm);
}

// (RTP, RFP, SDIS, DP, DPR, DTB, SDIR, RPA, RPO, RPAP, POSS): out with the spindle stopped.
void CycleCalls::bore(const Flow& call, const Hole& hole) {
  const PlaneAxes axes = axes_of(state_.plane);
  const Axes above = state_.position;
  const double unit = state_.unit_mm;
  // SDIR is an M number: 4 is M4, everything else M3.
  state_.spindle_direction = value(call, 6) == 4.0 ? -1 : 1;
  out_.spindle();
  out_.along(MoveKind::linear, hole.normal, hole.bottom_mm);
  if (value(call, kDtb) > 0.0) {
    out_.dwell(value(call, kDtb));
  }
  const int direction = state_.spindle_direction;
  state_.spindle_direction = 0;
  out_.spindle();
  // RPA, RPO, RPAP, all increments, lift the tool off the wall before it comes out.
  Axes aside = state_.position;
  aside[axes.first] += value(call, 7) * unit;
  aside[axes.second] += value(call, 8) * unit;
  aside[axes.normal] += value(call, 9) * unit;
  out_.move(MoveKind::rapid, aside);
  out_.along(MoveKind::rapid, hole.normal, hole.start_mm);
  out_.back_over(above, axes.normal, hole.retract_mm, direction);
}

// (RTP, RFP, SDIS, DP, DPR, DTB, SDAC, MPIT, PIT, POSS, SST, SST1): the feed follows the spindle.
bool CycleCalls::tap(const Flow& call, const Hole& hole) {
  // A negative size or pitch is a left-hand thread.
  const double size = value(call, 7);
  const double pitch =
      size != 0.0 ? coarse_pitch(std::abs(size)) : std::abs(value(call, 8)) * state_.unit_mm;
  const bool left = (size != 0.0 ? size : value(call, 8)) < 0.0;
  const double speed = value(call, 10);
  const double out = value(call, 11) != 0.0 ? value(call, 11) : speed;
  if (!(pitch > 0.0) || (size != 0.0 && value(call, 8) != 0.0)) {
    return refuse(call, "pitch_missing",
                  "CYCLE84 without its pitch: a size M3 to M48 (MPIT) or the pitch (PIT)");
  }
  if (!(speed > 0.0) || !(out > 0.0)) {
    return refuse(call, "speed_missing", "CYCLE84 without its spindle speed (SST)");
  }
  const double after = value(call, 6);
  if (after != 3.0 && after != 4.0 && after != 5.0) {
    return refuse(call, "bad_value",
                  "CYCLE84 without what the spindle does after it (SDAC: 3, 4 or 5)");
  }
  // The cycle's own feed mode, pitch and speed must not stay in force after it.
  const State kept = state_;
  state_.surface_speed = false;
  state_.feed_mode = FeedMode::per_revolution;
  state_.feed_mm_s = pitch;
  state_.spindle_direction = left ? -1 : 1;
  state_.spindle_speed_rev_s = speed / 60.0;
  out_.spindle();
  out_.along(MoveKind::thread, hole.normal, hole.bottom_mm);
  if (value(call, kDtb) > 0.0) {
    out_.dwell(value(call, kDtb));
  }
  // Out with the spindle reversed, at SST1 if given: the pitch keeps both in step.
  state_.spindle_direction = -state_.spindle_direction;
  state_.spindle_speed_rev_s = out / 60.0;
  out_.spindle();
  out_.along(MoveKind::thread, hole.normal, hole.start_mm);
  state_.feed_mode = kept.feed_mode;
  state_.feed_mm_s = kept.feed_mm_s;
  state_.surface_speed = kept.surface_speed;
  state_.spindle_speed_rev_s = kept.spindle_speed_rev_s;
  // SDAC says which way the spindle turns afterwards.
  state_.spindle_direction = after == 3.0 ? 1 : after == 4.0 ? -1 : 0;
  out_.spindle();
  out_.along(MoveKind::rapid, hole.normal, hole.retract_mm);
  return true;
}

}  // namespace steadyrest::nc::interpret
