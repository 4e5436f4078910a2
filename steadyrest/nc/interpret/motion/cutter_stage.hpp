// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <steadyrest/nc/interpret/control/stage.hpp>
#include <steadyrest/nc/interpret/state/cutter_compensation.hpp>

namespace steadyrest::nc::interpret {

/// G40, G41, G42, G41.1, G42.1: puts cutter compensation between the output and the sink while it
/// is on, and feeds it the contour.
class CutterStage : private Stage {
 public:
  using Stage::Stage;

  /// Sets where moves go from here on, through the compensation if it is on.
  void send_to(Sink& sink) noexcept {
    compensation_.bind(sink);
    out_.send_to(state_.cutter_side != 0 ? static_cast<Sink&>(compensation_) : sink);
  }
  /// The block's G40 … G42.
  bool set(const Step& step);
  /// G40: also at the end of the program.
  bool end(const Step& step);
  /// Before a stop of the program.
  bool stop(const Step& step);
  /// The closing %: waiting moves go out.
  void end_mark(std::uint32_t line);

  /// Moves must go through compensate().
  [[nodiscard]] bool active() const noexcept { return compensation_.active(); }
  bool compensate(const Step& step, MoveKind kind, const Axes& end);
  /// False from G40 to the next straight move.
  [[nodiscard]] bool arc_allowed() const noexcept { return arc_allowed_; }
  void goes_straight() noexcept { arc_allowed_ = true; }

 private:
  using Fault = CutterCompensation::Fault;
  bool choose_tool(const Step& step, int code, CutterCompensation::Tool& tool);
  bool refuse(const Step& step, Fault fault);

  CutterCompensation compensation_;
  bool arc_allowed_ = true;
};

}  // namespace steadyrest::nc::interpret
