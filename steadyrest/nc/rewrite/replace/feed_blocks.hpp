// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <string>
#include <vector>

#include <steadyrest/kernel/outcome/result.hpp>
#include <steadyrest/nc/plan/path/planned_path.hpp>
#include <steadyrest/nc/read/text/dialect.hpp>
#include <steadyrest/nc/rewrite/replace/block_text.hpp>
#include <steadyrest/nc/rewrite/replace/cut_blocks.hpp>
#include <steadyrest/nc/rewrite/replace/replace.hpp>

namespace steadyrest::nc::rewrite {

/// What the text permits on a segment of a program's path.
enum class FeedUse : std::uint8_t {
  anywhere,  ///< its block can be divided: the feed may change inside
  whole,     ///< its block can have another feed: a spiral, or several blocks that became one line
  joined,    ///< it belongs to the block of the segment before: the rounding of a corner
  kept       ///< its block must stay
};
/// By segment.
[[nodiscard]] std::vector<FeedUse> feed_uses(const plan::PlannedPath& path,
                                             const CutBlocks& blocks);

/// By segment: how much at its start and its end must keep one feed, so that the rounding of the
/// corners there finds its share of the block (Control::blend_share), mm.
[[nodiscard]] std::vector<std::array<float, 2>> rounding_ends(const plan::PlannedPath& path,
                                                              const CutBlocks& blocks,
                                                              double blend_share);

/// A feed along part of a segment, as a share of the programmed one.
struct FeedStretch {
  std::uint32_t segment = 0;
  double from_mm = 0.0;
  double to_mm = 0.0;
  double ratio = 1.0;
};

/// The lines that give a program these feeds. Blocks are divided where a feed changes inside them;
/// F is written only where it changes, and put back before a block that must stay.
///
/// `stretches`: in order, of all segments that are not kept. `path`: planned from the program.
[[nodiscard]] kernel::outcome::Result<NewLines> feed_lines(const std::string& program,
                                                           read::Dialect dialect,
                                                           const plan::PlannedPath& path,
                                                           const CutBlocks& blocks,
                                                           std::span<const FeedStretch> stretches);

}  // namespace steadyrest::nc::rewrite
