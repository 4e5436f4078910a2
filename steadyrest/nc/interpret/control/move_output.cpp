// SPDX-License-Identifier: Apache-2.0
#include <steadyrest/nc/interpret/control/coordinates.hpp>
#include <steadyrest/nc/interpret/control/move_output.hpp>
#include <steadyrest/nc/interpret/state/move_table.hpp>

namespace steadyrest::nc::interpret {
namespace {

// When only rotary axes move, the feed is in degrees per second; with any linear axis it is along X
// Y Z.
bool only_rotary_moves(const Axes& from, const Axes& to) noexcept {
  bool rotary = false;
  for (std::size_t i = 0; i < from.size(); ++i) {
    if (from[i] != to[i]) {
      if (!is_rotary(i)) {
        return false;
      }
      rotary = true;
    }
  }
  return rotary;
}

}  // namespace

void MoveOutput::put_modes(Move& move) const noexcept {
  move.offset = state_.offset;
  move.rotation_deg = state_.rotation_in_force_deg;
  move.feed_mode = state_.feed_mode;
  move.path_mode = state_.path_mode;
  move.path_tolerance_mm = state_.path_tolerance_mm;
  move.merge_tolerance_mm = state_.merge_tolerance_mm;
  move.spindle_rev_s =
      state_.surface_speed ? 0.0 : state_.spindle_direction * state_.spindle_speed_rev_s;
  move.surface_speed_mm_s = state_.spindle_direction * state_.surface_speed_mm_s;
  move.spindle_limit_rev_s = state_.spindle_limit_rev_s;
}

Move& MoveOutput::fill(MoveKind kind, const Axes& end) noexcept {
  current_.kind = kind;
  current_.start = state_.position;
  current_.end = end;
  put_modes(current_);
  // A rapid has no programmed feed.
  const bool cutting = kind != MoveKind::rapid;
  current_.feed_mm_s = !cutting                                  ? 0.0
                       : only_rotary_moves(state_.position, end) ? state_.feed_deg_s
                                                                 : state_.feed_mm_s;
  current_.override_locked = state_.override_off || kind == MoveKind::thread;
  current_.dwell_s = 0.0;
  current_.speed_modulation = state_.speed_modulation;
  return current_;
}

void MoveOutput::move(MoveKind kind, const Axes& end) {
  fill(kind, end);
  // After G40 the tool is still off the contour. The first move starts there and ends on the
  // contour.
  if (beside_mm_) {
    time_by_contour();
    current_.start = take_place();
  }
  state_.position = end;
  send();
  current_.machine_axes = 0;
}

// A new move: the current one may be half filled, with an arc's centre or machine axes set.
void MoveOutput::dwell(double seconds) {
  Move out;
  out.kind = MoveKind::dwell;
  out.line = current_.line;
  out.start = place();
  out.end = out.start;
  put_modes(out);
  out.override_locked = state_.override_off;
  out.dwell_s = seconds;
  sink_->on_move(out);
}

void MoveOutput::back_over(const Axes& above, std::size_t axis, double level,
                           int spindle_direction) {
  Axes end = above;
  end[axis] = level;
  move(MoveKind::rapid, end);
  state_.spindle_direction = spindle_direction;
  spindle();
}

// Cycles are made of moves along one axis.
void MoveOutput::along(MoveKind kind, std::size_t axis, double value) {
  Axes end = state_.position;
  end[axis] = value;
  move(kind, end);
}

// Rev/s with the sign of the direction. Under G96 the speed depends on X, so the event has 0 and
// the moves carry the cutting speed.
void MoveOutput::spindle() {
  const double speed = state_.surface_speed ? 0.0 : state_.spindle_speed_rev_s;
  event(EventKind::spindle, state_.spindle_direction * speed);
}

void MoveOutput::event(EventKind kind, double value, std::string_view tool_name) {
  sink_->on_event({.kind = kind, .line = current_.line, .value = value, .tool_name = tool_name});
}

// G93 gives the time of the block. Under compensation the contour's length counts, not the tool
// path's, which differs at every corner; converted to a feed, it holds for any resulting path.
void MoveOutput::time_by_contour() noexcept {
  if (current_.feed_mode == FeedMode::inverse_time && current_.kind != MoveKind::rapid) {
    current_.feed_mm_s *= path_length(current_);
    current_.feed_mode = FeedMode::per_minute;
  }
}

void MoveOutput::stand_at(const Axes& place) noexcept {
  beside_mm_ = to_machine(state_, place);
}

Axes MoveOutput::place() const noexcept {
  return beside_mm_ ? to_work(state_, *beside_mm_) : state_.position;
}

Axes MoveOutput::take_place() noexcept {
  const Axes out = place();
  beside_mm_.reset();
  return out;
}

}  // namespace steadyrest::nc::interpret
