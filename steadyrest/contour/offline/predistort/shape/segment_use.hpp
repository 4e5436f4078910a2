// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <set>
#include <vector>

#include <steadyrest/contour/offline/predistort/shape/command_shape.hpp>
#include <steadyrest/nc/plan/path/planned_path.hpp>
#include <steadyrest/nc/rewrite/replace/cut_blocks.hpp>

namespace steadyrest::contour::offline {

/// What may be done with each segment of a path: those of free blocks may be replaced, but for
/// `barred` lines and for blocks beside an arc in space by which the control rounds a corner.
[[nodiscard]] std::vector<SegmentUse> segment_use(const nc::plan::PlannedPath& path,
                                                  const nc::rewrite::CutBlocks& blocks,
                                                  const std::set<std::uint32_t>& barred);

}  // namespace steadyrest::contour::offline
