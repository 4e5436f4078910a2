// SPDX-License-Identifier: Apache-2.0
#include <bit>
#include <cmath>

#include <steadyrest/nc/interpret/blocks/interpreter.hpp>

// Nearly all lines of a long program are G0 or G1, F and axis words. Of all that check() and act()
// look for, only what is done here can come of such a block.
namespace steadyrest::nc::interpret {
namespace {

constexpr std::uint32_t kRotaryMask = Step::bit('A') | Step::bit('B') | Step::bit('C');
constexpr std::uint32_t kRotaryAxes = 0b111000;  // in Axes

}  // namespace

bool Interpreter::is_plain(const Step& step) const noexcept {
  const int motion = step.code(GGroup::motion);
  const int now = motion != kNoCode ? motion : state_.motion;
  return !step.others && rules_->short_way && (now == g::kRapid || now == g::kLinear) &&
         (motion != kNoCode || (step.mask & kAxisMask) != 0) && state_.cutter_side == 0 &&
         !cutter_->active() && spline_points_.empty();
}

/// end_point() of a plain block; false where check_values() finds a fault.
bool Interpreter::plain_end(const Step& step, Axes& end) const noexcept {
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

/// `filled`: the move before came of a plain block, too, so that its modes are those in force.
bool Interpreter::execute_plain(const Step& step, bool filled) {
  const int motion = step.code(GGroup::motion);
  motion_now_ = motion != kNoCode ? motion : state_.motion;
  Axes end;
  if (!plain_end(step, end)) {
    return check_values(step);
  }
  move_.line = step.line;
  move_.speed_modulation = state_.speed_modulation;
  if (step.has('F')) {
    set_feed(step);
  }
  state_.motion = motion_now_;
  cubic_goes_on_ = false;
  const bool cutting = motion_now_ == g::kLinear;
  const bool fed = state_.feed_mode == FeedMode::per_minute && state_.feed_mm_s > 0.0;
  if (cutting && !fed && !has_feed(step)) {
    return false;
  }
  arc_allowed_ = true;
  const MoveKind kind = cutting ? MoveKind::linear : MoveKind::rapid;
  if (!filled || (step.mask & kRotaryMask) != 0) {
    plain_before_ = !beside_;
    emit(kind, end);
    return true;
  }
  plain_before_ = true;
  move_.kind = kind;
  move_.start = state_.position;
  move_.end = end;
  move_.feed_mm_s = cutting ? state_.feed_mm_s : 0.0;
  state_.position = end;
  sink_->on_move(move_);
  return true;
}

}  // namespace steadyrest::nc::interpret
