// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <string_view>

#include <steadyrest/nc/interpret/state/move.hpp>
#include <steadyrest/nc/interpret/state/state.hpp>

namespace steadyrest::nc::interpret {

/// Sends moves and events to the sink, with the modes in force. Each move updates the state's
/// position.
class MoveOutput {
 public:
  explicit MoveOutput(State& state) noexcept : state_(state) {}

  void send_to(Sink& sink) noexcept { sink_ = &sink; }
  void begin_block(std::uint32_t line) noexcept { current_.line = line; }
  [[nodiscard]] std::uint32_t line() const noexcept { return current_.line; }
  /// The next move: whatever a stage sets here goes out with it. The stage resets it afterwards.
  [[nodiscard]] Move& current() noexcept { return current_; }

  /// Completes the next move without sending it.
  Move& fill(MoveKind kind, const Axes& end) noexcept;
  void move(MoveKind kind, const Axes& end);
  /// Along one axis.
  void along(MoveKind kind, std::size_t axis, double value);
  /// Rapid to `above`, but at `level` of the axis along the hole; then sets the spindle.
  void back_over(const Axes& above, std::size_t axis, double level, int spindle_direction);
  /// A straight move with the modes of the previous one, which must still be in force.
  void move_on(MoveKind kind, const Axes& end) {
    current_.kind = kind;
    current_.start = state_.position;
    current_.end = end;
    current_.feed_mm_s = kind == MoveKind::rapid ? 0.0 : state_.feed_mm_s;
    state_.position = end;
    sink_->on_move(current_);
  }
  void dwell(double seconds);
  /// Sends the spindle's state.
  void spindle();
  void event(EventKind kind, double value, std::string_view tool_name = {});

  /// In G93 the contour's length gives the feed, whatever the path of the tool centre.
  void time_by_contour() noexcept;
  /// The tool's offset from the current point after G40, until the next move.
  [[nodiscard]] const std::optional<Axes>& beside() const noexcept { return beside_; }
  void stand_beside(const Axes& by) noexcept { beside_ = by; }
  /// `point` plus the tool's offset from it, which is cleared.
  [[nodiscard]] Axes take_beside(Axes point) noexcept;

 private:
  /// Copies frame, modes and spindle from the state.
  void put_modes(Move& move) const noexcept;

  State& state_;
  Sink* sink_ = nullptr;
  Move current_;
  std::optional<Axes> beside_;
};

}  // namespace steadyrest::nc::interpret
