// SPDX-License-Identifier: Apache-2.0
// The control's clock goes back by five seconds in the cut, and runs on from there.
#include <gtest/gtest.h>
#include <tests/scenarios/shared/stage.hpp>

namespace steadyrest::scenarios {
namespace {

using kernel::outcome::Reason;

constexpr std::size_t kSet = 1000;

TEST(TimeBackwards, ASetClockIsNamedAndMovesNothing) {
  Stage stage;
  stage.show = [](std::size_t cycle, kernel::signal::Frame& frame) {
    frame.time_s -= cycle >= kSet ? 5.0 : 0.0;
  };
  stage.run(1500);
  EXPECT_EQ(stage.named(Reason::input_out_of_range, 0, kSet), 0U);
  EXPECT_EQ(stage.named(Reason::input_out_of_range, kSet, 1500), 1U)
      << "the second stamp proves it";
  EXPECT_TRUE(stage.log()[kSet + 1].masks());
  EXPECT_EQ(stage.largest_rise(kSet, kSet + 3), 0.0);
  EXPECT_LT(stage.log()[1499].feed_ratio(), 0.6) << "it goes on correcting";
}

TEST(TimeBackwards, AClockThatOnlyGoesBackHandsBackNothingByAJump) {
  Stage stage;
  stage.show = [](std::size_t cycle, kernel::signal::Frame& frame) {
    if (cycle >= kSet) {
      frame.time_s = 4.0 - 0.004 * static_cast<double>(cycle - kSet);
    }
  };
  stage.run(1500);
  EXPECT_GT(stage.named(Reason::input_out_of_range, kSet, 1500), 490U);
  EXPECT_EQ(stage.largest_rise(kSet, 1500), 0.0) << "no time has passed for the slew";
}

}  // namespace
}  // namespace steadyrest::scenarios
