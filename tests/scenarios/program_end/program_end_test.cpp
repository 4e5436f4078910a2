// SPDX-License-Identifier: Apache-2.0
// The program ends (M2) while the layer stays: nothing of it is left on the feed.
#include <gtest/gtest.h>
#include <tests/scenarios/shared/stage.hpp>

namespace steadyrest::scenarios {
namespace {

using kernel::outcome::Reason;

TEST(ProgramEnd, TheFeedGoesBackAndTheLoopGoesOn) {
  Stage stage({.program = "G17 G90 G94 G71\nS3000 M3\nG0 X10 Y0\nG3 X10 Y0 I-10 J0 F4000\nM2\n"});
  stage.run(3000);
  const auto& log = stage.log();
  EXPECT_TRUE(stage.machine_finished());
  double lowest = 1.0;
  for (const Cycle& cycle : log) {
    lowest = std::min(lowest, cycle.feed_ratio());
  }
  EXPECT_LT(lowest, 0.6);
  for (std::size_t i = 2500; i < 3000; ++i) {
    ASSERT_FALSE(log[i].masks());
    ASSERT_EQ(log[i].status.reasons[0], Reason::not_cutting);
    ASSERT_EQ(log[i].status.mode_in_force, kernel::machine::Mode::act);
  }
}

}  // namespace
}  // namespace steadyrest::scenarios
