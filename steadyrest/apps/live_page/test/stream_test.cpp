// SPDX-License-Identifier: Apache-2.0
#include <cmath>
#include <string>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <steadyrest/apps/live_page/stream.hpp>
#include <steadyrest/apps/live_page/test/page_desk.hpp>

namespace steadyrest::apps::live_page {
namespace {

using test::PageDesk;
using testing::SizeIs;

Json frame_of(PageDesk& desk) {
  StreamText stream(desk.desk());
  return Json::parse("{" + stream.frame());
}

TEST(Stream, HasWhatEachStepOfTheOverrideWouldGive) {
  PageDesk desk;
  desk.tap().watch(true);
  desk.loop().run();
  const Json frame = frame_of(desk);
  EXPECT_EQ(frame["path_known"], true);
  ASSERT_THAT(frame["steps"], SizeIs(23));
  const Json& steps = frame["steps"];
  EXPECT_EQ(steps[8]["percent"], 30.0);
  EXPECT_LT(std::abs(steps[8]["error_um"].get<double>()), steps[18]["error_um"]);
  EXPECT_TRUE(steps[8]["change_um"].is_number());
}

TEST(Stream, HasNoStepsWhereNobodyLooked) {
  PageDesk desk;
  desk.loop().run();
  EXPECT_EQ(frame_of(desk)["steps"], nullptr);
}

// One edge a cycle bounds the velocity of a moving axis; of one at rest, and of any acceleration,
// it leaves more than the machine can do.
TEST(Stream, ShowsNoBoundWiderThanTheAxisCanMove) {
  PageDesk desk;
  desk.loop().run();
  const Json axes = frame_of(desk)["axes"];
  ASSERT_THAT(axes, SizeIs(3));
  bool has_one = false;
  for (const Json& axis : axes) {
    const Json& velocity = axis["velocity_bound_mm_min"];
    const Json& acceleration = axis["acceleration_bound_mm_s2"];
    EXPECT_TRUE(velocity.is_null() || velocity < 24'000.0) << axis;
    EXPECT_TRUE(acceleration.is_null() || acceleration < 6000.0) << axis;
    has_one = has_one || velocity.is_number();
  }
  EXPECT_TRUE(has_one) << axes;
  EXPECT_TRUE(axes[0]["acceleration_bound_mm_s2"].is_null()) << axes;
}

}  // namespace
}  // namespace steadyrest::apps::live_page
