// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <steadyrest/nc/rewrite/prove/verify_moves.hpp>

namespace steadyrest::nc::rewrite {

/// verify() for a correction that the machine adds outside the program's coordinates (an
/// R-parameter).
///
/// The blocks are the original's, byte for byte, and so are the moves; the proof is about where the
/// value is written and which one. Every group of inserted lines must be, character for character,
/// the text of a planned step, at a rapid or a clearance of the original, in its window; the value
/// is zero from the head to the first group and from the end on.
[[nodiscard]] kernel::outcome::Result<Proved> verify_beside(const Claim& claim,
                                                            const interpret::Config& config,
                                                            bool timed);

}  // namespace steadyrest::nc::rewrite
