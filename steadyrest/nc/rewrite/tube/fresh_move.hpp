// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>

#include <steadyrest/nc/interpret/state/move.hpp>
#include <steadyrest/nc/rewrite/tube/permitted.hpp>

namespace steadyrest::nc::rewrite {

/// What a new move has that the block in whose place it is does not allow, apart from its path: its
/// kind, feed, spindle, offset, modes, other axes. Empty when nothing.
[[nodiscard]] std::string fresh_move_difference(const Permitted& permitted,
                                                const interpret::Move& block, interpret::Move move);

}  // namespace steadyrest::nc::rewrite
