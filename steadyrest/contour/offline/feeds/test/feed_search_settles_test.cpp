// SPDX-License-Identifier: Apache-2.0
// What makes the search end and what it leaves alone: ceilings, groups, limits by segment.
#include <gtest/gtest.h>

#include <steadyrest/contour/offline/closed_form.hpp>
#include <steadyrest/contour/offline/feeds/test/search_scene.hpp>

namespace steadyrest::contour::offline {
namespace {

using test::SearchScene;

const char* const kTwoCircles =
    "G0 X10 Y0\nG4 P0.5\nG3 X10 Y0 I-10 J0 P2 F4000\nG1 Y60\nG3 X10 Y60 I-10 J0 P2\n";

/// The ratio of the first circle when its limit is lifted after one step that slowed it down.
double ratio_after_lift(SearchScene& scene, bool settle) {
  scene.measured_s();
  scene.search.adjust(settle);
  const double slowed = scene.middle_ratio(1);
  EXPECT_LT(slowed, 0.5);
  scene.search.set_limit(1, 1.0);
  scene.measured_s();
  scene.search.adjust(settle);
  EXPECT_GT(scene.middle_ratio(1), slowed);
  return scene.middle_ratio(1);
}

TEST(FeedSearchSettles, ACellThatWasTooFastIsNeverThatFastAgain) {
  SearchScene looking(kTwoCircles);
  EXPECT_DOUBLE_EQ(ratio_after_lift(looking, false), 1.0);
  SearchScene settling(kTwoCircles);
  EXPECT_LT(ratio_after_lift(settling, true), 0.8);
  settling.measured_s();
  settling.search.adjust(true);
  EXPECT_LT(settling.middle_ratio(1), 0.8);
}

TEST(FeedSearchSettles, NewGroupsLiftTheCeilings) {
  SearchScene scene(kTwoCircles);
  EXPECT_LT(ratio_after_lift(scene, true), 0.8);
  scene.search.set_groups(scene.search.group());
  scene.measured_s();
  scene.search.adjust(true);
  EXPECT_DOUBLE_EQ(scene.middle_ratio(1), 1.0);
}

}  // namespace
}  // namespace steadyrest::contour::offline
