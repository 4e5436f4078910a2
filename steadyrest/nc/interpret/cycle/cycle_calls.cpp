// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <array>
#include <cmath>

#include <steadyrest/nc/interpret/cycle/cycle_calls.hpp>
#include <steadyrest/nc/read/sinumerik/sinumerik_names.hpp>

namespace steadyrest::nc::interpret {
namespace {

using read::Flow;

struct Known {
  std::string_view name;
  int number;
  std::size_t values;  ///< how many it takes; further ones of newer versions must be omitted or 0
};
constexpr std::array kKnownCycles = {
    Known{"CYCLE81", 81, 5}, Known{"CYCLE82", 82, 6},  Known{"CYCLE84", 84, 12},
    Known{"CYCLE85", 85, 8}, Known{"CYCLE86", 86, 11},
};

constexpr bool given(const Flow& call, std::size_t place) noexcept {
  return place < call.count && (call.given >> place & 1U) != 0;
}
constexpr double value(const Flow& call, std::size_t place) noexcept {
  return given(call, place) ? call.values[place] : 0.0;
}

// Places of the values.
constexpr std::size_t kRtp = 0;
constexpr std::size_t kRfp = 1;
constexpr std::size_t kSdis = 2;
constexpr std::size_t kDp = 3;
constexpr std::size_t kDpr = 4;
constexpr std::size_t kDtb = 5;

// Metric coarse threads, ISO 261: MPIT is the nominal size.
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

}  // namespace

/// One hole, in mm along the normal axis of the plane.
struct CycleCalls::Hole {
  std::size_t normal = 2;
  double start_mm = 0.0;  ///< reference plane and safety clearance
  double bottom_mm = 0.0;
  double retract_mm = 0.0;
};

bool CycleCalls::refuse(const Flow& call, std::string_view reason, std::string_view text) {
  return refusals_.call(out_.line(), call, reason, text);
}

bool CycleCalls::call(const Flow& call) {
  if (call.kind == read::FlowKind::modal_call) {  // of a subprogram, instead of a cycle
    modal_.reset();
    return true;
  }
  if (call.kind != read::FlowKind::modal_cycle) {
    return drill(call);
  }
  // MCALL without a name ends the modal call; with one, the planes are checked at once, so a fault
  // is reported in its own line, not at the first hole.
  modal_.reset();
  Hole hole;
  if (call.label.view().empty()) {
    return true;
  }
  if (!planes(call, hole)) {
    return false;
  }
  modal_ = call;
  return true;
}

// The interpreter calls this after every block that moves an axis.
bool CycleCalls::after_move() {
  return !modal_ || drill(*modal_);
}

// The planes common to all cycles: retraction, reference and safety clearance, depth.
bool CycleCalls::planes(const Flow& call, Hole& hole) {
  const std::string_view name = call.label.view();
  const auto* const known = std::ranges::find_if(
      kKnownCycles, [&](const Known& one) { return read::equal(name, one.name); });
  if (known == kKnownCycles.end()) {
    return refuse(call, "cycle_not_interpreted",
                  "a cycle that is not interpreted; CYCLE81, 82, 84, 85 and 86 are");
  }
  // The control treats an omitted value as zero.
  for (std::size_t i = known->values; i < call.count; ++i) {
    if (value(call, i) != 0.0) {
      return refuse(call, "cycle_value",
                    "a value that only newer versions of the cycle have; leave it out");
    }
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

// CYCLE800() without values switches swivelling off, and none can be on.
bool CycleCalls::drill(const Flow& call) {
  if (read::equal(call.label.view(), "CYCLE800")) {
    return call.count == 0 ||
           refuse(call, "transformation", "swivelling (CYCLE800) is not interpreted");
  }
  Hole hole;
  if (!planes(call, hole)) {
    return false;
  }
  const double dwell = value(call, kDtb);
  if (!(dwell >= 0.0 && dwell <= 1e6)) {
    return refuse(call, "out_of_range",
                  "a dwell in revolutions (negative) or of more than 1000000 s");
  }
  // CYCLE81 … CYCLE86 differ in their last digit.
  const char number = call.label.view().back();
  if (number != '4' && number != '5' && !(state_.feed_mm_s > 0.0)) {
    return refuse(call, "feed_missing", "a drilling cycle, but no feed (F) is in force");
  }
  if (state_.feed_mode == FeedMode::inverse_time) {
    return refuse(call, "cycle_in_inverse_time",
                  "a drilling cycle while inverse-time feed (G93) is in force");
  }
  if (number == '5' && !(value(call, 6) > 0.0 && value(call, 7) > 0.0)) {
    return refuse(call, "feed_missing", "CYCLE85 without its feeds (FFR, RFF)");
  }
  // Every cycle begins with a rapid to the reference plane plus clearance.
  out_.along(MoveKind::rapid, hole.normal, hole.start_mm);
  switch (number) {
    case '4':
      return tap(call, hole);
    case '5':
      ream(call, hole);
      return true;
    case '6':
      bore(call, hole);
      return true;
    default:
      break;
  }
  out_.along(MoveKind::linear, hole.normal, hole.bottom_mm);
  if (number == '2' && dwell > 0.0) {
    out_.dwell(dwell);
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
