// SPDX-License-Identifier: Apache-2.0
// The operator aborts the program in the cut; then another program begins.
#include <gtest/gtest.h>
#include <tests/scenarios/shared/stage.hpp>

namespace steadyrest::scenarios {
namespace {

using kernel::outcome::Reason;
using kernel::signal::Frame;

constexpr std::size_t kAborts = 1000;
constexpr std::size_t kNextProgram = 1600;

TEST(Abort, TheFeedGoesBackToThePanelBySlew) {
  Stage stage;
  Frame since;
  stage.show = [&since](std::size_t cycle, Frame& frame) {
    if (cycle == kAborts) {
      since = frame;
    }
    if (cycle >= kAborts && cycle < kNextProgram) {
      stand(frame, since);
      frame.path = {};
    }
  };
  stage.run(2200);
  const auto& log = stage.log();
  EXPECT_LT(log[kAborts - 1].feed_ratio(), 0.6);
  EXPECT_LT(log[kAborts + 20].feed_ratio(), 0.85) << "not at once";
  EXPECT_FALSE(log[kNextProgram - 1].masks());
  EXPECT_GT(stage.named(Reason::not_cutting, kAborts, kNextProgram), 350U);
  EXPECT_LT(log[2199].feed_ratio(), 0.6) << "the next program is corrected";
}

TEST(Abort, WhenTheLayerIsLeftThenItsOffsetsGoOutOfTheCutOnly) {
  Stage stage;
  Frame since;
  stage.show = [&since](std::size_t cycle, Frame& frame) {
    if (cycle == kAborts) {
      since = frame;
    }
    if (cycle >= kAborts) {
      stand(frame, since);
    }
  };
  stage.wish = [](std::size_t cycle, live::Loop& loop) {
    if (cycle == kAborts - 100) {
      loop.ask_mode(kernel::machine::Mode::observe);
    }
  };
  stage.run(2000);
  const auto& log = stage.log();
  const auto& frozen_mm = log[kAborts - 90].written->offset_mm;
  EXPECT_NE(frozen_mm[2], 0.0);
  // For a second of idle the tool may still be in the cut: it could be between two blocks.
  for (std::size_t i = kAborts - 90; i < kAborts + 240; ++i) {
    ASSERT_TRUE(log[i].written);
    ASSERT_EQ(log[i].written->offset_mm, frozen_mm);
  }
  EXPECT_FALSE(log[1999].written) << "handed back";
  EXPECT_EQ(log[1999].status.mode_in_force, kernel::machine::Mode::observe);
}

}  // namespace
}  // namespace steadyrest::scenarios
