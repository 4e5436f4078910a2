// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <steadyrest/nc/interpret/control/control.hpp>
#include <steadyrest/nc/interpret/control/move_output.hpp>

namespace steadyrest::nc::interpret {

/// Base of every stage: reads and sets the control's state and sends out moves.
class Stage {
 public:
  Stage(Control& control, MoveOutput& out) noexcept
      : control_(control), state_(control.state), refusals_(control.refusals), out_(out) {}

 protected:
  Control& control_;
  State& state_;
  Refusals& refusals_;
  MoveOutput& out_;
};

}  // namespace steadyrest::nc::interpret
