// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <cmath>
#include <string_view>

#include <steadyrest/nc/interpret/motion/corner_geometry.hpp>
#include <steadyrest/nc/interpret/motion/corners.hpp>

namespace steadyrest::nc::interpret {
namespace {

constexpr std::string_view kWithoutNext =
    "the block after a chamfer or rounding (,C ,R) must be a cut (G1 G2 G3) in the same plane, "
    "with "
    "nothing else in it";

constexpr bool cuts_by(int motion) noexcept {
  return motion == g::kLinear || motion == g::kArcClockwise || motion == g::kArcCounterClockwise;
}

CornerSide side_of(const Move& move, const PlaneAxes& plane) noexcept {
  return {.start = {.first = move.start[plane.first], .second = move.start[plane.second]},
          .end = {.first = move.end[plane.first], .second = move.end[plane.second]},
          .arc = move.kind == MoveKind::arc,
          .centre = {.first = move.centre_mm[plane.first], .second = move.centre_mm[plane.second]},
          .clockwise = move.turns < 0};
}

/// It goes somewhere, within the plane.
bool lies_in(const Move& move, const PlaneAxes& plane) noexcept {
  bool goes = move.kind == MoveKind::arc;
  for (std::size_t i = 0; i < move.end.size(); ++i) {
    const bool differs = move.start[i] != move.end[i];
    if (differs && i != plane.first && i != plane.second) {
      return false;
    }
    goes = goes || differs;
  }
  return goes;
}

void place(Axes& axes, const PlaneAxes& plane, const PlanePoint& point) noexcept {
  axes[plane.first] = point.first;
  axes[plane.second] = point.second;
}

}  // namespace

bool Corners::refuse_corner(const Step& step, std::string_view reason, std::string_view text) {
  return refusals_.named(step, step.fanuc.corner == 'C' ? ",C" : ",R", reason, text);
}

bool Corners::refuse_end(std::uint32_t line) {
  read::Word mark;
  mark.text = "%";
  return refusals_.word(line, mark, "corner_without_next", kWithoutNext);
}

bool Corners::permits(const Step& step) {
  if (held_ && !may_follow(step)) {
    return refusals_.block(step, "corner_without_next", kWithoutNext);
  }
  if (!step.has_fanuc || step.fanuc.corner == 0) {
    return true;
  }
  if (!cuts_by(step.moves_by) || step.machine_frame) {
    return refuse_corner(
        step, "corner_without_cut",
        "a chamfer or rounding (,C ,R) in a block that does not cut by G1, G2 or G3");
  }
  if (!(step.fanuc.corner_words > 0.0) || step.fanuc.corner_words > 1e7) {
    return refuse_corner(step, "out_of_range", "a chamfer or rounding that is not above zero");
  }
  const auto unscaled = [](double factor) { return std::abs(factor) == 1.0; };
  return std::ranges::all_of(state_.text_frame.factor, unscaled) ||
         refuse_corner(step, "corner_scaled",
                       "a chamfer or rounding (,C ,R) while scaling is in force");
}

bool Corners::may_follow(const Step& step) {
  const auto given = [](int code) { return code != kNoCode; };
  constexpr std::uint32_t kOthers = Step::bit('S') | Step::bit('T');
  bool codes = false;
  for (std::size_t i = 0; i < step.g.size(); ++i) {
    const auto group = static_cast<GGroup>(i);
    codes = codes || (given(step.g[i]) && group != GGroup::motion && group != GGroup::distance);
  }
  return cuts_by(step.moves_by) && !codes && !std::ranges::any_of(step.m, given) &&
         (step.mask & kOthers) == 0 && step.modulation < 0 && !step.rigid_tap;
}

// The corner waits with its move until the next block shows where it leads.
bool Corners::move(const Step& step, MoveKind kind, const Axes& end) {
  Move move = out_.fill(kind, end);
  const bool begins = step.has_fanuc && step.fanuc.corner != 0;
  if (!lies_in(move, axes_of(state_.plane))) {
    return refusals_.block(step, "corner_off_plane",
                           "a chamfer or rounding (,C ,R) beside a move that does not stay in the "
                           "plane, or goes nowhere");
  }
  if (held_ && !join(step, move)) {
    return false;
  }
  held_.reset();
  if (begins) {
    held_ = {.move = move,
             .kind = step.fanuc.corner,
             .length_mm = step.fanuc.corner_words * state_.unit_mm};
  } else {
    out_.put(move);
  }
  state_.position = end;
  return true;
}

// Sends the first move up to the corner, and the corner; the next one begins behind it.
bool Corners::join(const Step& step, Move& next) {
  const PlaneAxes plane = axes_of(state_.plane);
  Move& first = held_->move;
  const CornerSide side_1 = side_of(first, plane);
  const CornerSide side_2 = side_of(next, plane);
  const bool chamfers = held_->kind == 'C';
  const auto cut = chamfers ? chamfer(side_1, side_2, held_->length_mm)
                            : rounding(side_1, side_2, held_->length_mm);
  if (!cut) {
    switch (cut.error()) {
      case CornerFault::straight:
        out_.put(first);
        return true;
      case CornerFault::beside_arc:
        return refusals_.block(step, "corner_beside_arc",
                               "a chamfer (,C) beside an arc is not interpreted");
      case CornerFault::reversal:
        return refusals_.block(step, "corner_reversal",
                               "a corner between moves that go back along each other");
      case CornerFault::too_large:
        return refusals_.block(step, "corner_too_large",
                               "the chamfer or rounding (,C ,R) before this block does not fit");
    }
  }
  Move corner = first;
  place(first.end, plane, cut->from);
  out_.put(first);
  corner.kind = chamfers ? MoveKind::linear : MoveKind::arc;
  corner.start = first.end;
  place(corner.end, plane, cut->to);
  corner.centre_mm = {};
  corner.normal = {};
  corner.turns = 0;
  if (!chamfers) {
    corner.centre_mm = {corner.start[0], corner.start[1], corner.start[2]};
    corner.centre_mm[plane.first] = cut->centre.first;
    corner.centre_mm[plane.second] = cut->centre.second;
    corner.normal[plane.normal] = 1.0;
    corner.turns = cut->clockwise ? -1 : 1;
  }
  out_.put(corner);
  next.start = corner.end;
  return true;
}

}  // namespace steadyrest::nc::interpret
