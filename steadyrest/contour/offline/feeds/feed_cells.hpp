// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <vector>

#include <steadyrest/contour/offline/predict/model_run.hpp>
#include <steadyrest/nc/plan/path/planned_path.hpp>

namespace steadyrest::contour::offline {

/// What may be done with the feed of a segment.
enum class FeedKind : std::uint8_t {
  free,    ///< it may change anywhere inside
  whole,   ///< it has one feed
  joined,  ///< it has the feed that the segment before ends with: the rounding of a corner
  fixed    ///< the programmed one
};

/// What can be chosen where.
struct FeedRoom {
  std::vector<FeedKind> kind;  ///< by segment; empty: all free
  /// By segment: at least so much at its start and its end has one feed; empty: none.
  std::vector<std::array<float, 2>> ends_mm;
  double station_mm = 0.25;          ///< longest cell, > 0
  std::size_t most_cells = 400'000;  ///< cells are longer where there would be more
};

/// A planned path whose feed moves are divided into short cells; each cell may have another feed.
///
/// Cell i is segment i of `path`. Everything else stays as the planner made it: geometry, limits,
/// corners and events.
struct FeedCells {
  nc::plan::PlannedPath path;
  PathMap map;                    ///< of `path` to the original
  std::vector<std::uint32_t> of;  ///< the segment that each cell is part of
  std::vector<FeedKind> kind;
  std::vector<double> from_mm;  ///< where in its segment the cell begins
  std::vector<double> ceiling;  ///< the segment's own feed, in its unit
};

/// Only feed moves that an override acts on are divided; all others are `fixed`.
[[nodiscard]] FeedCells feed_cells(const nc::plan::PlannedPath& path, const PathMap& map,
                                   const FeedRoom& room);

}  // namespace steadyrest::contour::offline
