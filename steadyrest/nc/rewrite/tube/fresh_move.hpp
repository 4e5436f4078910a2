// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <span>
#include <string>

#include <steadyrest/nc/interpret/state/move.hpp>
#include <steadyrest/nc/read/text/block.hpp>
#include <steadyrest/nc/rewrite/tube/permitted.hpp>

namespace steadyrest::nc::rewrite {

/// What a new move has that the block in whose place it is does not allow, apart from its path: its
/// kind, feed, spindle, offset, modes, other axes. Empty when nothing.
[[nodiscard]] std::string fresh_move_difference(const Permitted& permitted,
                                                const interpret::Move& block, interpret::Move move);

/// Why its words may not be those of a new line that cuts. Empty where they may.
[[nodiscard]] std::string words_fault(const read::Block& block);

/// A new line makes a dwell and nothing else, where dwells are permitted.
[[nodiscard]] bool is_wait(const Permitted& permitted,
                           std::span<const interpret::Move> moves) noexcept;
/// Why it may not wait there or so long: `begins` (the first line in place of `block`, behind a
/// rapid, so that the tool does not wait in the cut), its time alone, in seconds as written, at
/// most 5 s, and not at feeds per revolution, where some controls count turns. Empty where it may.
[[nodiscard]] std::string wait_fault(const read::Block& words, const interpret::Move& block,
                                     double seconds, bool begins);

}  // namespace steadyrest::nc::rewrite
