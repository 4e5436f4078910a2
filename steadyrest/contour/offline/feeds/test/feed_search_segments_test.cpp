// SPDX-License-Identifier: Apache-2.0
// Groups of cells, limits by segment, and segments whose feed is not the search's to choose.
#include <cstddef>
#include <cstdint>

#include <gtest/gtest.h>

#include <steadyrest/contour/offline/closed_form.hpp>
#include <steadyrest/contour/offline/feeds/test/search_scene.hpp>

namespace steadyrest::contour::offline {
namespace {

using test::SearchScene;

/// The circles are segments 1 and 3.
const char* const kCirclesApart =
    "G0 X10 Y0\nG4 P0.5\nG3 X10 Y0 I-10 J0 P2 F4000\nG1 Y60\nG3 X10 Y60 I-10 J0 P2\n";

TEST(FeedSearchBySegment, AGroupHasOneFeedThatSuitsItsWorstCell) {
  SearchScene scene(kCirclesApart);
  scene.search.set_groups(scene.cells.of);
  scene.measured_s();
  scene.search.adjust(true);
  for (std::size_t i = 1; i < scene.cells.of.size(); ++i) {
    if (scene.cells.of[i] == scene.cells.of[i - 1]) {
      EXPECT_EQ(scene.search.ratio()[i], scene.search.ratio()[i - 1]) << i;
    }
  }
  scene.measured_s();
  for (const std::uint32_t circle : {1U, 3U}) {
    EXPECT_LT(scene.search.runs()[scene.middle(circle)].error_mm, 0.0105F);
  }
}

TEST(FeedSearchBySegment, FixedCellsKeepTheirFeedAndJoinedOnesThatOfTheCellBefore) {
  SearchScene scene(
      kCirclesApart, {},
      {.kind = {FeedKind::free, FeedKind::fixed, FeedKind::free, FeedKind::joined}, .ends_mm = {}});
  const std::size_t joined = scene.middle(3);
  EXPECT_EQ(scene.search.group()[joined], scene.search.group()[joined - 1]);
  scene.measured_s();
  scene.search.adjust(false);
  EXPECT_DOUBLE_EQ(scene.middle_ratio(1), 1.0);
  EXPECT_LT(scene.middle_ratio(3), 0.5);
  EXPECT_DOUBLE_EQ(scene.search.ratio()[joined], scene.search.ratio()[joined - 1]);
}

TEST(FeedSearchBySegment, ALimitHoldsForTheCellsOfItsSegment) {
  SearchScene scene(kCirclesApart, {.limit_mm = 0.02});
  scene.search.set_limit(3, 0.005);
  for (std::size_t i = 0; i < scene.cells.of.size(); ++i) {
    EXPECT_NEAR(scene.search.limit_mm(i), scene.cells.of[i] == 3 ? 0.005 : 0.02, 1e-8) << i;
  }
  scene.measured_s();
  scene.search.adjust(false);
  const auto speed = [](double limit_mm) {
    return circle_limit({.gain_1_s = 50.0}, 10.0, limit_mm).value().speed_mm_s;
  };
  EXPECT_NEAR(scene.middle_ratio(1) / scene.middle_ratio(3), speed(0.02) / speed(0.005), 0.02);
}

}  // namespace
}  // namespace steadyrest::contour::offline
