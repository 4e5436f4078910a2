// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <string_view>

#include <steadyrest/nc/interpret/state/move.hpp>
#include <steadyrest/nc/interpret/state/state.hpp>

namespace steadyrest::nc::interpret {

/// Gives moves and events to the sink, with the modes in force. Whatever moves brings the state's
/// position along.
class MoveOutput {
 public:
  explicit MoveOutput(State& state) noexcept : state_(state) {}

  void send_to(Sink& sink) noexcept { sink_ = &sink; }
  void begin_block(std::uint32_t line) noexcept { current_.line = line; }
  [[nodiscard]] std::uint32_t line() const noexcept { return current_.line; }
  /// The next move: what a stage sets here goes out with it. The stage takes it back.
  [[nodiscard]] Move& current() noexcept { return current_; }

  /// Completes the next move without sending it.
  Move& fill(MoveKind kind, const Axes& end) noexcept;
  void move(MoveKind kind, const Axes& end);
  /// Along one axis.
  void along(MoveKind kind, std::size_t axis, double value);
  /// In rapid to where `above` is, but at `level` of the axis along the hole; then the spindle.
  void back_over(const Axes& above, std::size_t axis, double level, int spindle_direction);
  /// A straight move with the modes of the one before, which were those in force now.
  void move_on(MoveKind kind, const Axes& end) {
    current_.kind = kind;
    current_.start = state_.position;
    current_.end = end;
    current_.feed_mm_s = kind == MoveKind::rapid ? 0.0 : state_.feed_mm_s;
    state_.position = end;
    sink_->on_move(current_);
  }
  void dwell(double seconds);
  /// The spindle as the state has it.
  void spindle();
  void event(EventKind kind, double value, std::string_view tool_name = {});

  /// In G93 the length of the contour gives the feed, whatever way the tool's centre has.
  void time_by_contour() noexcept;
  /// Behind G40 the tool stands beside the point in force, by this, until the next move.
  [[nodiscard]] const std::optional<Axes>& beside() const noexcept { return beside_; }
  void stand_beside(const Axes& by) noexcept { beside_ = by; }
  /// `point` and where the tool stands beside it, from now on at the point in force.
  [[nodiscard]] Axes take_beside(Axes point) noexcept;

 private:
  /// Frame, modes and spindle as the state has them.
  void put_modes(Move& move) const noexcept;

  State& state_;
  Sink* sink_ = nullptr;
  Move current_;
  std::optional<Axes> beside_;
};

}  // namespace steadyrest::nc::interpret
