// SPDX-License-Identifier: Apache-2.0
// Which neighbours may never share a feed, which must, and which may for nothing.
#include <algorithm>
#include <cstddef>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include <steadyrest/contour/offline/feeds/feed_groups.hpp>
#include <steadyrest/contour/offline/feeds/test/search_scene.hpp>

namespace steadyrest::contour::offline {
namespace {

using test::SearchScene;

const FeedRoom kApart1mm{.kind = {}, .ends_mm = {}, .station_mm = 1.0};
constexpr FewFeeds kAnyLoss{.most_loss_s = 1e3, .shortest_s = 0.0};

/// The number of groups on moves whose cells have run at these ratios; 1 where none are given.
std::size_t groups_on(SearchScene& scene, const FewFeeds& few, std::vector<double> ratio = {}) {
  ratio.resize(scene.cells.of.size(), 1.0);
  scene.search.set_ratios(ratio);
  scene.measured_s();
  return group_feeds(scene.cells, scene.search, few, ratio).back() + 1;
}

TEST(FeedGroupsApart, SegmentsOfOneFeedMayShareIt) {
  SearchScene scene("G4 P0.5\nG1 X10 F600\nX20\nX30\n", {.limit_mm = 1.0}, kApart1mm);
  EXPECT_EQ(groups_on(scene, kAnyLoss, {1.0, 0.5, 0.8}), 1U);
}

TEST(FeedGroupsApart, EqualNeighboursCostNothing) {
  SearchScene scene("G4 P0.5\nG1 X10 F600\nX20\nX30\n", {.limit_mm = 1.0}, kApart1mm);
  std::vector<double> ratio(30, 0.6);
  std::fill_n(ratio.begin() + 13, 3, 0.9);
  EXPECT_EQ(groups_on(scene, {.most_loss_s = 0.0, .shortest_s = 0.0}, ratio), 3U);
}

// However long the control waits before a cell, a lower feed costs what it costs in motion:
// 1 s at 1.0 is 1.25 s at 0.8.
TEST(FeedGroupsApart, ADwellCostsNothingAtALowerFeed) {
  for (const char* const dwell : {"G4 P0.1\n", "G4 P20\n"}) {
    SearchScene scene(std::string(dwell) + "G1 X10 F600\nX30\n", {.limit_mm = 1.0}, kApart1mm);
    std::vector<double> ratio(30, 0.8);
    std::fill_n(ratio.begin(), 10, 1.0);
    EXPECT_EQ(groups_on(scene, {.most_loss_s = 0.27, .shortest_s = 0.0}, ratio), 1U) << dwell;
    EXPECT_EQ(groups_on(scene, {.most_loss_s = 0.23, .shortest_s = 0.0}, ratio), 2U) << dwell;
  }
}

// A ratio of F600 is another feed than that of F900; feed per revolution has another unit.
TEST(FeedGroupsApart, SegmentsOfOtherFeedsNeverDo) {
  SearchScene scene("G4 P0.5\nG1 X10 F600\nX20 F900\nX30 F600\n", {.limit_mm = 1.0}, kApart1mm);
  EXPECT_EQ(groups_on(scene, kAnyLoss), 3U);
  SearchScene turning("G4 P0.5\nG1 X10 F600\nX20\nX30\n", {.limit_mm = 1.0}, kApart1mm);
  for (std::size_t i = 10; i < 20; ++i) {
    turning.cells.path.plans[i].per_revolution = true;
  }
  std::vector<double> ratio(30, 1.0);
  EXPECT_EQ(group_feeds(turning.cells, turning.search, kAnyLoss, ratio).back(), 2U);
}

TEST(FeedGroupsApart, FixedCellsStayAlone) {
  SearchScene scene("G4 P0.5\nG1 X10 F600\nX20\nX30\n", {.limit_mm = 1.0},
                    {.kind = {FeedKind::free, FeedKind::fixed, FeedKind::free},
                     .ends_mm = {},
                     .station_mm = 1.0});
  EXPECT_EQ(groups_on(scene, kAnyLoss), 3U);
}

}  // namespace
}  // namespace steadyrest::contour::offline
