// SPDX-License-Identifier: Apache-2.0
// Which segments of a planned path may be commanded otherwise, and where the control stops.
#include <vector>

#include <gtest/gtest.h>

#include <steadyrest/contour/offline/predistort/shape/test/used_path.hpp>

namespace steadyrest::contour::offline {
namespace {

using test::UsedPath;

TEST(SegmentUse, FreeAreTheCutsOfFreeBlocksThatAreNotBarred) {
  UsedPath used(6);
  EXPECT_EQ(used.free(), "ffffff");
  EXPECT_EQ(used.free({2, 5}), "f-ff-f");
  used.blocks.blocks[1].stays = nc::rewrite::Stays::calculated;
  used.path.segments[3].motion = kernel::signal::Motion::rapid;
  used.blocks.blocks.pop_back();  // line 6 does not cut
  EXPECT_EQ(used.free(), "f-f-f-");
}

// Work coordinates turned about Z leave G18 and G19 no plane that an arc could be written in.
TEST(SegmentUse, ATurnedOffsetIsFreeInTheXyPlaneOnly) {
  UsedPath used(3);
  for (auto& block : used.blocks.blocks) {
    block.rotation_deg = 30.0;
  }
  used.blocks.blocks[1].plane = nc::interpret::Plane::zx;
  EXPECT_EQ(used.free(), "f-f");
  used.blocks.blocks[1].rotation_deg = 0.0;
  EXPECT_EQ(used.free(), "fff");
}

TEST(SegmentUse, StopsAreWhereTheControlRestsOrSomethingHappens) {
  UsedPath used(5);
  used.path.segments[1].exit_speed_limit_mm_s = 0.0;
  used.path.events = {{.segment = 0}, {.segment = 4}};
  const auto use = segment_use(used.path, used.blocks, {});
  std::vector<bool> stops;
  for (const SegmentUse& one : use) {
    stops.push_back(one.stops);
  }
  // An event before segment 4 is at the end of segment 3; the one before all is at no end.
  EXPECT_EQ(stops, (std::vector<bool>{false, true, false, true, false}));
}

}  // namespace
}  // namespace steadyrest::contour::offline
