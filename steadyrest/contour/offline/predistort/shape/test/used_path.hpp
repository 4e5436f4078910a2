// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <set>
#include <string>

#include <steadyrest/contour/offline/predistort/shape/segment_use.hpp>
#include <steadyrest/contour/online/test/paths.hpp>

namespace steadyrest::contour::offline::test {

/// Lines of 10 mm, each the block of the next line number, none of which stops.
struct UsedPath {
  explicit UsedPath(std::uint32_t count) {
    online::test::PathMaker maker({0, 0, 0}, 50.0);
    for (std::uint32_t line = 1; line <= count; ++line) {
      maker.line_to({10.0 * line, 0, 0});
      blocks.blocks.push_back({.line = line});
    }
    path.segments = maker.path();
    for (std::uint32_t i = 0; i < count; ++i) {
      path.segments[i].line = i + 1;
    }
  }
  /// One character for each segment: f free, - not.
  [[nodiscard]] std::string free(const std::set<std::uint32_t>& barred = {}) const {
    std::string out;
    for (const SegmentUse& use : segment_use(path, blocks, barred)) {
      out += use.free ? 'f' : '-';
    }
    return out;
  }
  nc::plan::PlannedPath path;
  nc::rewrite::CutBlocks blocks;
};

}  // namespace steadyrest::contour::offline::test
