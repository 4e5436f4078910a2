// SPDX-License-Identifier: Apache-2.0
#include <cmath>
#include <cstddef>

#include <steadyrest/contour/offline/predistort/shape/segment_use.hpp>

namespace steadyrest::contour::offline {
namespace {

constexpr double kInPlane = 0.999999;  ///< of an arc's axis along the plane's normal

/// All segments of this one's block stay.
void keep_line(const std::vector<kernel::signal::PathSegment>& segments,
               std::vector<SegmentUse>& use, std::size_t segment) {
  if (segment >= use.size()) {
    return;
  }
  const std::uint32_t line = segments[segment].line;
  std::size_t first = segment;
  while (first > 0 && segments[first - 1].line == line) {
    --first;
  }
  for (std::size_t i = first; i < use.size() && segments[i].line == line; ++i) {
    use[i].free = false;
  }
}

}  // namespace

std::vector<SegmentUse> segment_use(const nc::plan::PlannedPath& path,
                                    const nc::rewrite::CutBlocks& blocks,
                                    const std::set<std::uint32_t>& barred) {
  std::vector<SegmentUse> use(path.segments.size());
  for (std::size_t i = 0; i < use.size(); ++i) {
    const auto& segment = path.segments[i];
    const nc::rewrite::CutBlock* block = blocks.find(segment.line);
    const bool turned =
        block != nullptr && block->rotation_deg != 0.0 && block->plane != nc::interpret::Plane::xy;
    use[i].free = segment.motion == kernel::signal::Motion::feed && block != nullptr &&
                  block->stays == nc::rewrite::Stays::free && block->plane_known && !turned &&
                  !barred.contains(segment.line);
    use[i].stops = segment.exit_speed_limit_mm_s <= 0.0;
    use[i].plane = block != nullptr ? block->plane : nc::interpret::Plane::xy;
  }
  // An arc in space by which the control rounds a corner cannot be written: its neighbours stay.
  for (std::size_t i = 0; i < use.size(); ++i) {
    const auto& segment = path.segments[i];
    const std::size_t normal = nc::interpret::axes_of(use[i].plane).normal;
    if (use[i].free && segment.geometry == kernel::signal::Geometry::arc &&
        std::abs(segment.axis[normal]) < kInPlane) {
      keep_line(path.segments, use, i);
      keep_line(path.segments, use, i + 1);
    }
  }
  for (const nc::plan::PathEvent& event : path.events) {
    if (event.segment > 0 && event.segment <= use.size()) {
      use[event.segment - 1].stops = true;
    }
  }
  return use;
}

}  // namespace steadyrest::contour::offline
