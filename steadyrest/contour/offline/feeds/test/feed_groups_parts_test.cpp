// SPDX-License-Identifier: Apache-2.0
// Parts of a segment: too short for a block of their own, or never at their feed.
#include <algorithm>
#include <cstdint>
#include <vector>

#include <gtest/gtest.h>

#include <steadyrest/contour/offline/feeds/feed_groups.hpp>
#include <steadyrest/contour/offline/feeds/test/search_scene.hpp>

namespace steadyrest::contour::offline {
namespace {

using test::SearchScene;

const FeedRoom kParts1mm{.kind = {}, .ends_mm = {}, .station_mm = 1.0};

std::uint32_t groups_after(SearchScene& scene, const FewFeeds& few, std::vector<double> ratio) {
  scene.search.set_ratios(ratio);
  scene.measured_s();
  return group_feeds(scene.cells, scene.search, few, ratio).back() + 1;
}

// 1 mm at 0.9 is 0.11 s, too short for a block of 0.15 s. At 0.6 it costs another 0.056 s, at 0.5
// 0.089 s.
TEST(FeedGroupsInASegment, APartTooShortForABlockGoesWhereItCostsLess) {
  for (const bool before : {true, false}) {
    SearchScene scene("G4 P0.5\nG1 X21 F600\n", {.limit_mm = 1.0}, kParts1mm);
    std::vector<double> ratio(21, before ? 0.6 : 0.5);
    ratio[10] = 0.9;
    std::fill(ratio.begin() + 11, ratio.end(), before ? 0.5 : 0.6);
    scene.search.set_ratios(ratio);
    scene.measured_s();
    const auto group =
        group_feeds(scene.cells, scene.search, {.most_loss_s = 0.1, .shortest_s = 0.15}, ratio);
    EXPECT_EQ(std::ranges::count(group, 0U), before ? 11 : 10);
    EXPECT_EQ(std::ranges::count(group, 1U), before ? 10 : 11);
    EXPECT_EQ(ratio[10], 0.6);
  }
}

// Even where every loss is more than may be lost.
TEST(FeedGroupsInASegment, APartTooShortForABlockIsNeverLeft) {
  SearchScene scene("G4 P0.5\nG1 X21 F600\n", {.limit_mm = 1.0}, kParts1mm);
  std::vector<double> ratio(21, 0.6);
  ratio[5] = ratio[15] = 0.9;
  EXPECT_EQ(groups_after(scene, {.most_loss_s = 0.001, .shortest_s = 0.0}, ratio), 5U);
  EXPECT_EQ(groups_after(scene, {.most_loss_s = 0.001, .shortest_s = 0.15}, ratio), 1U);
}

TEST(FeedGroupsInASegment, AShortSegmentIsABlockAlready) {
  SearchScene scene("G4 P0.5\nG1 X10 F600\nX11\nX21\n", {.limit_mm = 1.0}, kParts1mm);
  std::vector<double> ratio(21, 1.0);
  ratio[10] = 0.7;
  EXPECT_EQ(groups_after(scene, {.most_loss_s = 0.02, .shortest_s = 0.25}, ratio), 3U);
}

// From rest at 2000 mm/s² the first millimetre ends at 63 mm/s of 100: 0.65 takes nothing from it.
// In the middle of the line the same millimetre is run at 100 mm/s.
TEST(FeedGroupsInASegment, ACellThatNeverReachesItsFeedLosesNothing) {
  for (const bool at_start : {true, false}) {
    SearchScene scene("G4 P0.5\nG1 X20 F6000\n", {.limit_mm = 1.0}, kParts1mm);
    std::vector<double> ratio(20, 0.65);
    std::fill_n(ratio.begin() + (at_start ? 0 : 8), at_start ? 1 : 6, 1.0);
    EXPECT_EQ(groups_after(scene, {.most_loss_s = 0.0, .shortest_s = 0.0}, ratio),
              at_start ? 1U : 3U);
  }
}

}  // namespace
}  // namespace steadyrest::contour::offline
