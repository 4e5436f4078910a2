// SPDX-License-Identifier: Apache-2.0
#include <cstddef>

#include <steadyrest/contour/offline/predistort/polish/chain_bounds.hpp>
#include <steadyrest/contour/offline/predistort/shift.hpp>
#include <steadyrest/math/geometry/path_pairing.hpp>
#include <steadyrest/math/geometry/vector.hpp>

namespace steadyrest::contour::offline {

namespace geometry = math::geometry;

namespace {

constexpr double kMostShift = 0.95;  ///< of the largest shift: the text is rounded

}  // namespace

/// How far the end of a block's last piece is from the end of the block.
double ChainBounds::from_block_end_mm(const Piece& last) const {
  const auto& segments = config_.path.segments;
  const std::uint32_t line = last.segment.line;
  std::size_t i = geometry::segment_at(segments, last.progress_end_mm);
  while (i > 0 && segments[i].line != line) {
    --i;
  }
  while (i + 1 < segments.size() && segments[i + 1].line == line) {
    ++i;
  }
  return geometry::distance(segments[i].end_mm, last.segment.end_mm);
}

/// The command is ahead of the tool.
double ChainBounds::most_from_end_mm(const Piece& last) const {
  return 2.0 * config_.most_shift_mm + 1.5 * last.segment.feed_mm_s / config_.gain_1_s;
}

bool ChainBounds::left_by(const std::vector<Piece>& pieces) const {
  for (std::size_t i = 1; i < pieces.size(); ++i) {
    const Piece& before = pieces[i - 1];
    if (pieces[i].segment.line != before.segment.line &&
        from_block_end_mm(before) > most_from_end_mm(before)) {
      return true;
    }
  }
  return !shift_of(config_.path, pieces, kMostShift * config_.most_shift_mm).too_far.empty();
}

}  // namespace steadyrest::contour::offline
