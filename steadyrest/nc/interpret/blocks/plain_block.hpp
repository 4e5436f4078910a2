// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <utility>

#include <steadyrest/nc/interpret/blocks/machine_words.hpp>
#include <steadyrest/nc/interpret/check/block_check.hpp>
#include <steadyrest/nc/interpret/control/stage.hpp>
#include <steadyrest/nc/interpret/motion/cutter_stage.hpp>
#include <steadyrest/nc/interpret/motion/splines.hpp>

namespace steadyrest::nc::interpret {

/// The short way for a block of G0 or G1, F and axis words alone: nearly all lines of a long
/// program. Of all that the checks and the other stages look for, only what is done here can come
/// of such a block. `test/plain_block_test.cpp` holds it against the long way.
class PlainBlock : private Stage {
 public:
  PlainBlock(Control& control, MoveOutput& out, MachineWords& machine, CutterStage& cutter,
             Splines& splines) noexcept
      : Stage(control, out), machine_(machine), cutter_(cutter), splines_(splines) {}

  [[nodiscard]] bool takes(const Step& step) const noexcept;
  /// `follows`: so did the block before, and the modes of its move are those in force.
  bool execute(Step& step, bool follows);

  /// The block that was executed last was such a block: of the state its position, motion and feed
  /// alone may be others than before.
  [[nodiscard]] bool was_last() const noexcept { return was_last_; }
  /// Another block, or a change of modes. True when the last one was a plain one.
  bool forget() noexcept { return std::exchange(was_last_, false); }

 private:
  [[nodiscard]] bool end_of(const Step& step, Axes& end) const noexcept;

  MachineWords& machine_;
  CutterStage& cutter_;
  Splines& splines_;
  bool was_last_ = false;
};

}  // namespace steadyrest::nc::interpret
