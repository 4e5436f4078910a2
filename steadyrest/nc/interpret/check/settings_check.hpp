// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <steadyrest/nc/interpret/control/control.hpp>
#include <steadyrest/nc/interpret/state/step.hpp>
#include <steadyrest/nc/read/text/block.hpp>

/// What the control's configuration (Config::settings) makes of a block. False when it is refused.
namespace steadyrest::nc::interpret {

/// linuxcnc: a remapped code has the meaning of the machine's own files, which are not read here;
/// M98 and M99 may be switched off.
bool check_remapped(const read::Block& block, Control& control);

/// linuxcnc: an axis with WRAPPED_ROTARY takes angles within a turn; an indexer moves alone, by G0.
bool check_rotary(const Step& step, Control& control);

}  // namespace steadyrest::nc::interpret
