// SPDX-License-Identifier: Apache-2.0
#include <bit>
#include <cmath>

#include <steadyrest/nc/interpret/blocks/plain_block.hpp>

namespace steadyrest::nc::interpret {
namespace {

// Nearly all lines of a CAM program are G0 or G1, axes and F. For these the checks and most stages
// have nothing to do. The result must equal the long path's exactly: plain_block_test runs random
// programs both ways.

constexpr std::uint32_t kRotaryMask = Step::bit('A') | Step::bit('B') | Step::bit('C');
constexpr std::uint32_t kRotaryAxes = 0b111000;  // in Axes

}  // namespace

bool PlainBlock::takes(const Step& step) const noexcept {
  const int motion = step.code(GGroup::motion);
  const int now = motion != kNoCode ? motion : state_.motion;
  // Cutter compensation and open splines hold a move back or change it: not here.
  return !step.others && control_.rules.short_way && (now == g::kRapid || now == g::kLinear) &&
         (motion != kNoCode || (step.mask & kAxisMask) != 0) &&
         (step.mask & (control_.wrapped | control_.indexers)) == 0 && state_.cutter_side == 0 &&
         !cutter_.active() && !splines_.open();
}

// end_point() of such a block; false where check_values() finds a fault.
bool PlainBlock::end_of(const Step& step, Axes& end) const noexcept {
  end = state_.position;
  bool fits = !step.has('F') || (step['F'] >= 0.0 && step['F'] <= kLargestValue);
  const double x_scale = state_.diameter ? 0.5 * state_.unit_mm : state_.unit_mm;
  for (std::uint32_t left = step.mask & kAxisMask; left != 0; left &= left - 1) {
    const auto letter = static_cast<std::size_t>(std::countr_zero(left));
    const std::size_t i = kAxisOfLetter[letter];
    const double value = step.value[letter];
    fits = fits && std::abs(value) <= kLargestValue;
    const bool rotary = ((kRotaryAxes >> i) & 1U) != 0;
    const double way = value * (rotary ? 1.0 : i == 0 ? x_scale : state_.unit_mm);
    end[i] = state_.incremental ? end[i] + way : way;
  }
  return fits;
}

// With `follows` the current move is the previous one: only kind, end and feed can differ.
bool PlainBlock::execute(Step& step, bool follows) {
  const int motion = step.code(GGroup::motion);
  step.moves_by = motion != kNoCode ? motion : state_.motion;
  Axes end;
  if (!end_of(step, end)) {
    return BlockCheck(control_).check_values(step);
  }
  out_.begin_block(step.line);
  if (step.has('F')) {
    machine_.feed(step);
  }
  state_.motion = step.moves_by;
  state_.plain_motion = step.moves_by;
  splines_.interrupt();
  const bool cutting = step.moves_by == g::kLinear;
  const bool fed = state_.feed_mode == FeedMode::per_minute && state_.feed_mm_s > 0.0;
  if (cutting && !fed && !has_feed(step, state_, refusals_)) {
    return false;
  }
  cutter_.goes_straight();
  const MoveKind kind = cutting ? MoveKind::linear : MoveKind::rapid;
  // A rotary axis may turn the feed into degrees; then the whole move is filled in.
  if (!follows || (step.mask & kRotaryMask) != 0) {
    was_last_ = !out_.beside();
    out_.move(kind, end);
    return true;
  }
  was_last_ = true;
  out_.move_on(kind, end);
  return true;
}

}  // namespace steadyrest::nc::interpret
