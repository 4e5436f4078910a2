// SPDX-License-Identifier: Apache-2.0
// How far ahead a cell looks, against a search of the cells' own runs without a window.
#include <algorithm>
#include <cmath>
#include <cstddef>
#include <vector>

#include <gtest/gtest.h>

#include <steadyrest/contour/offline/feeds/test/search_scene.hpp>

namespace steadyrest::contour::offline {
namespace {

using test::SearchScene;

// A tool at a place still shows the speeds of the last 2/k = 40 ms.
TEST(FeedSearchReach, EachCellAnswersForTheLargestErrorWithinTwoLagsBehindIt) {
  constexpr double kLimit_mm = 0.01;
  SearchScene scene("G0 X0 Y0\nG4 P0.5\nG1 X20 F3000\nG3 X23 Y3 I0 J3\nG1 Y20\n",
                    {.limit_mm = kLimit_mm});
  scene.measured_s();
  const std::vector<CellRun> runs = scene.search.runs();
  scene.search.adjust(false);
  std::size_t slowed = 0;
  for (std::size_t i = 0; i < runs.size(); ++i) {
    double behind_s = 0.0;
    double worst = static_cast<double>(runs[i].of_feed_mm) / kLimit_mm;
    for (std::size_t j = i + 1; j < runs.size() && behind_s <= 2.0 / 50.0; ++j) {
      worst = std::max(worst, static_cast<double>(runs[j].of_feed_mm) / kLimit_mm);
      behind_s += static_cast<double>(runs[j].seconds);
    }
    if (scene.cells.kind[i] == FeedKind::free && worst > 1.0) {
      ++slowed;
      EXPECT_NEAR(scene.search.ratio()[i],
                  static_cast<double>(runs[i].speed_mm_s) / 50.0 / std::sqrt(worst), 1e-4)
          << i;
    }
  }
  EXPECT_GT(slowed, 20U);
  EXPECT_LT(slowed, runs.size() / 2);
}

}  // namespace
}  // namespace steadyrest::contour::offline
