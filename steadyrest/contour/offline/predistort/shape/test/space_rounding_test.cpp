// SPDX-License-Identifier: Apache-2.0
// Corners that the control rounds by arcs in space, which no block can say.
#include <gtest/gtest.h>

#include <steadyrest/contour/offline/predistort/shape/test/used_path.hpp>

namespace steadyrest::contour::offline {
namespace {

using test::UsedPath;

/// Line 2's corner is rounded by a separate arc, in the plane of this axis.
UsedPath with_rounding(const kernel::signal::Point& axis) {
  UsedPath used(4);
  auto& rounding = used.path.segments[2];
  rounding.geometry = kernel::signal::Geometry::arc;
  rounding.axis = axis;
  rounding.line = 2;
  used.path.segments[3].line = 3;
  return used;
}

TEST(SpaceRounding, BothBlocksOfARoundingInSpaceStay) {
  EXPECT_EQ(with_rounding({0, 0, 1}).free(), "ffff");
  EXPECT_EQ(with_rounding({0, 0, -1}).free(), "ffff");
  EXPECT_EQ(with_rounding({0, 0.6, 0.8}).free(), "f---");
  // In G19 an arc about X can be written, and one about Z cannot.
  UsedPath used = with_rounding({1, 0, 0});
  used.blocks.blocks[1].plane = nc::interpret::Plane::yz;
  EXPECT_EQ(used.free(), "ffff");
  used.path.segments[2].axis = {0, 0, 1};
  EXPECT_EQ(used.free(), "f---");
}

}  // namespace
}  // namespace steadyrest::contour::offline
