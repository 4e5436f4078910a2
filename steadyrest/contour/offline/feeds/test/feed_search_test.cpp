// SPDX-License-Identifier: Apache-2.0
// One step of the search: from what a run shows to the feeds of the next. Truth: the closed form of
// a circle (Koren 1980), and the cells' own runs searched without a window.
#include <gtest/gtest.h>

#include <steadyrest/contour/offline/closed_form.hpp>
#include <steadyrest/contour/offline/feeds/test/search_scene.hpp>

namespace steadyrest::contour::offline {
namespace {

using test::SearchScene;

constexpr double kSearchFeed_mm_s = 4000.0 / 60.0;
/// The dwell lets the axes arrive: segment 1 is the circle.
const char* const kSearchedCircle = "G0 X10 Y0\nG4 P0.5\nG3 X10 Y0 I-10 J0 P3 F4000\n";

TEST(FeedSearch, MeasuresTimeSpeedAndErrorOfEachCell) {
  SearchScene scene(kSearchedCircle);
  const double whole_s = scene.measured_s();
  const auto expected = circle_errors({.gain_1_s = 50.0}, 10.0, kSearchFeed_mm_s).value();
  const CellRun& middle = scene.search.runs()[scene.middle(1)];
  EXPECT_NEAR(middle.error_mm, expected.contour_error_mm, 1e-4);
  EXPECT_NEAR(middle.of_feed_mm, expected.contour_error_mm, 1e-4);
  EXPECT_NEAR(middle.speed_mm_s, kSearchFeed_mm_s, 1e-3);
  double sum_s = 0.0;
  for (const CellRun& cell : scene.search.runs()) {
    sum_s += static_cast<double>(cell.seconds);
  }
  EXPECT_NEAR(sum_s, whole_s, 0.02);
}

// ε ∝ v²: one step leaves what the law neglects.
TEST(FeedSearch, OneStepBringsACircleToItsLimit) {
  for (const double limit_mm : {0.005, 0.02}) {
    SearchScene scene(kSearchedCircle, {.limit_mm = limit_mm});
    scene.measured_s();
    EXPECT_FALSE(scene.search.keeps_limit());
    scene.search.adjust(false);
    const double most = circle_limit({.gain_1_s = 50.0}, 10.0, limit_mm).value().speed_mm_s;
    EXPECT_NEAR(scene.middle_ratio(1) * kSearchFeed_mm_s, most, 0.01 * most);
    scene.measured_s();
    EXPECT_NEAR(scene.search.runs()[scene.middle(1)].error_mm, limit_mm, 0.02 * limit_mm);
  }
}

TEST(FeedSearch, StaysBetweenTheFloorAndTheProgrammedFeed) {
  SearchScene tight(kSearchedCircle, {.limit_mm = 0.001, .floor_ratio = 0.4});
  tight.measured_s();
  tight.search.adjust(false);
  EXPECT_DOUBLE_EQ(tight.middle_ratio(1), 0.4);
  tight.measured_s();
  tight.search.adjust(false);
  // No lower feed could help the arc, so it counts as kept.
  tight.measured_s();
  EXPECT_GT(tight.search.runs()[tight.middle(1)].error_mm, 0.01F);
  EXPECT_TRUE(tight.search.keeps_limit());
  SearchScene close(kSearchedCircle, {.limit_mm = 0.99 * 0.0877});
  close.measured_s();
  EXPECT_FALSE(close.search.keeps_limit());
  SearchScene loose(kSearchedCircle, {.limit_mm = 0.2});
  loose.measured_s();
  EXPECT_TRUE(loose.search.keeps_limit());
  loose.search.adjust(false);
  EXPECT_DOUBLE_EQ(loose.middle_ratio(1), 1.0);
}

}  // namespace
}  // namespace steadyrest::contour::offline
