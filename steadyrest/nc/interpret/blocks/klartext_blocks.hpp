// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <steadyrest/nc/interpret/blocks/klartext_frames.hpp>
#include <steadyrest/nc/interpret/control/stage.hpp>
#include <steadyrest/nc/interpret/cycle/klartext_cycles.hpp>
#include <steadyrest/nc/interpret/motion/contour_corners.hpp>

namespace steadyrest::nc::interpret {

/// What blocks of `heidenhain` do that no other dialect has: poles, corners, definitions and calls
/// of cycles, words that act at the end of their block.
class KlartextBlocks : private Stage {
 public:
  KlartextBlocks(Control& control, MoveOutput& out) noexcept
      : Stage(control, out), frames_(control, out), cycles_(control, out) {}

  /// Where the moves of the next block go, on their way to `sink`.
  Sink& through(Sink& sink) noexcept {
    corners_.send_to(sink, state_.plane);
    return corners_;
  }
  void bind(const read::Values& q) noexcept { cycles_.bind(q); }

  /// The block is not a path function: execute() does all of it.
  [[nodiscard]] static bool takes(const Step& step) noexcept {
    return step.has_klartext && step.klartext.kind != KlartextStep::Kind::none;
  }
  bool execute(const Step& step);
  /// Before and after the stages of any other block.
  bool before(const Step& step);
  bool after(const Step& step);
  /// At the end of the program: no corner may be open.
  bool end(std::uint32_t line);

 private:
  bool define(const Step& step);
  bool sound(const Step& step);
  void tool(const Step& step);
  bool call(const Step& step);

  KlartextFrames frames_;
  KlartextCycles cycles_;
  ContourCorners corners_;
};

}  // namespace steadyrest::nc::interpret
