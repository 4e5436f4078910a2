// SPDX-License-Identifier: Apache-2.0
// The control takes every word and does nothing with it: no M52 on LinuxCNC, a PLC that was
// stopped.
#include <gtest/gtest.h>
#include <tests/scenarios/shared/stage.hpp>

namespace steadyrest::scenarios {
namespace {

TEST(ControlIgnoresUs, TheStatusShowsThatNothingActsAndTheLoopGoesOn) {
  Stage stage;
  stage.link = [](std::size_t) { return Stage::Link::ignored; };
  stage.run(1500);
  const auto& status = stage.log()[1499].status;
  EXPECT_LT(status.feed_ratio, 0.6) << "what the layer lets through";
  EXPECT_EQ(status.feed_effective_ratio, 1.0) << "what the control reports";
  EXPECT_GT(std::abs(status.contour_error_mm), status.contour_limit_mm);
  // (v/k)²/(2·R) = 88 µm since the circle began, about a second after the start.
  EXPECT_GT(stage.figures().over_limit_s, 4.0);
  EXPECT_EQ(stage.log()[1499].frame.axis[2].command_mm, 0.0) << "no offset acts";
}

}  // namespace
}  // namespace steadyrest::scenarios
