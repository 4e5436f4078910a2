// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <functional>
#include <string>
#include <string_view>
#include <vector>

#include <steadyrest/kernel/outcome/result.hpp>
#include <steadyrest/nc/interpret/parameters/known_state.hpp>
#include <steadyrest/nc/interpret/state/config.hpp>
#include <steadyrest/nc/rewrite/tube/permitted.hpp>

namespace steadyrest::nc::rewrite {

/// What a proof of replaced blocks has checked.
struct TubeProof {
  std::uint64_t moves = 0;           ///< of the changed program, dwells too
  std::uint64_t replaced_lines = 0;  ///< of the original
  std::uint64_t new_lines = 0;
  double tube_mm = 0.0;
  double farthest_mm = 0.0;         ///< largest distance of the new moves from the original's
  std::uint32_t farthest_line = 0;  ///< of the changed program
  double least_feed_ratio = 1.0;    ///< lowest feed as a share of the original's
  std::uint32_t slowest_line = 0;   ///< of the changed program, where that is; 0: none is lower
  /// What the original reads of values that the control decides. Lines that depend on one are the
  /// original's, begin as they do there, and no block that depends on one is replaced: so the proof
  /// holds for any answer.
  std::vector<interpret::Assumed> assumed;
};

/// Proves that `changed`, whose blocks were replaced (replace()), does what `original` does, except
/// for what is permitted.
///
/// With its replaced lines put back the text is the original, byte for byte. Both are run side by
/// side, line by line. Kept lines make the same moves and events (same_line.hpp). Replaced are
/// blocks that cut_blocks() calls free, by lines and arcs alone, which leave every mode as it was
/// except motion and feed; they stay within the tube of the original's path, in order, with nothing
/// left out (stretch.hpp), and their feeds are those permitted. Where speeds are, a line may also
/// have other values of S and F. At the end position, offsets, modes and what the control keeps are
/// the original's; the feed may be the last new block's. The axes keep within their travel, or
/// within what the original uses, where the machine and the start are known. All this with the
/// other position of block delete, too, where the program has lines with `/`.
///
/// Refused with the line of the changed program otherwise, or of the original where something of it
/// is missing.
[[nodiscard]] kernel::outcome::Result<TubeProof> verify_tube(
    const std::string& original, const std::string& changed, const interpret::Config& config,
    const Permitted& permitted,
    const std::function<void(double share, std::string_view what)>& progress = {});

}  // namespace steadyrest::nc::rewrite
