// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <utility>

#include <steadyrest/nc/interpret/blocks/machine_words.hpp>
#include <steadyrest/nc/interpret/check/block_check.hpp>
#include <steadyrest/nc/interpret/control/stage.hpp>
#include <steadyrest/nc/interpret/motion/cutter_stage.hpp>
#include <steadyrest/nc/interpret/motion/splines.hpp>

namespace steadyrest::nc::interpret {

/// The fast path for a block of only G0 or G1, F and axis words: nearly all lines of a long
/// program. Such a block can have no effect or fault other than those handled here.
/// `test/plain_block_test.cpp` compares it with the long path.
class PlainBlock : private Stage {
 public:
  PlainBlock(Control& control, MoveOutput& out, MachineWords& machine, CutterStage& cutter,
             Splines& splines) noexcept
      : Stage(control, out), machine_(machine), cutter_(cutter), splines_(splines) {}

  [[nodiscard]] bool takes(const Step& step) const noexcept;
  /// `follows`: the previous block was one too, and its move has the modes in force.
  bool execute(Step& step, bool follows);

  /// The last executed block was a plain one: of the state, only position, motion and feed may have
  /// changed.
  [[nodiscard]] bool was_last() const noexcept { return was_last_; }
  /// Notes another kind of block or a change of modes. True when the last block was plain.
  bool forget() noexcept { return std::exchange(was_last_, false); }

 private:
  [[nodiscard]] bool end_of(const Step& step, Axes& end) const noexcept;

  MachineWords& machine_;
  CutterStage& cutter_;
  Splines& splines_;
  bool was_last_ = false;
};

}  // namespace steadyrest::nc::interpret
