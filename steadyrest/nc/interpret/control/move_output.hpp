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
    send();
  }
  /// A move that has been filled in before.
  void put(const Move& move) { sink_->on_move(move); }
  /// The axes come to rest before the next move.
  void wait_for_rest() noexcept { current_.after_rest = true; }
  void dwell(double seconds);
  /// Sends the spindle's state.
  void spindle();
  void event(EventKind kind, double value, std::string_view tool_name = {});

  /// In G93 the contour's length gives the feed, whatever the path of the tool centre.
  void time_by_contour() noexcept;
  /// Until the next move the machine is elsewhere than the control counts with: after G40, and on
  /// linuxcnc after a rotation that has changed under G52 or G92.
  [[nodiscard]] bool beside() const noexcept { return beside_mm_.has_value(); }
  /// It is at this point, work coordinates; offsets that change meanwhile do not move it.
  void stand_at(const Axes& place) noexcept;
  /// Where the machine is, in the work coordinates in force.
  [[nodiscard]] Axes place() const noexcept;
  /// The same; from then on the control counts with it.
  [[nodiscard]] Axes take_place() noexcept;

 private:
  void send() {
    sink_->on_move(current_);
    current_.after_rest = false;
  }
  /// Copies frame, modes and spindle from the state.
  void put_modes(Move& move) const noexcept;

  State& state_;
  Sink* sink_ = nullptr;
  Move current_;
  std::optional<Axes> beside_mm_;  ///< machine coordinates
};

}  // namespace steadyrest::nc::interpret
