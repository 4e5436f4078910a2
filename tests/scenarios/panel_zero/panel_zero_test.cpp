// SPDX-License-Identifier: Apache-2.0
// The operator turns the feed to 0 in the cut, and on again.
#include <gtest/gtest.h>
#include <tests/scenarios/shared/stage.hpp>

namespace steadyrest::scenarios {
namespace {

using kernel::outcome::Reason;

TEST(PanelZero, StopsAtOnceAndTheOffsetStays) {
  const Stage tables;
  Stage stage(
      {.operator_actions = {
           {.time_s = 4.0, .act = sim::OperatorAct::turn_feed, .code = tables.feed_code(0.0)},
           {.time_s = 6.0, .act = sim::OperatorAct::turn_feed, .code = tables.feed_code(1.0)}}});
  stage.run(2500);
  const auto& log = stage.log();
  std::size_t stopped = 990;
  while (log[stopped].frame.feed.panel_ratio > 0.0) {
    ++stopped;
  }
  EXPECT_NEAR(static_cast<double>(stopped), 1000.0, 5.0);
  EXPECT_TRUE(log[stopped - 1].masks());
  EXPECT_FALSE(log[stopped].masks()) << "in the same cycle";
  EXPECT_EQ(stage.named(Reason::panel_zero, stopped, stopped + 490), 490U);
  for (std::size_t i = stopped; i < stopped + 490; ++i) {
    ASSERT_FALSE(log[i].masks());
    ASSERT_TRUE(i < stopped + 20 || log[i].frame.feed.effective_ratio == 0.0);
  }
  EXPECT_EQ(log[stopped + 400].frame.path_speed_mm_s, 0.0);
  EXPECT_NE(log[stopped + 400].written->offset_mm[2], 0.0) << "the tool is still in the cut";
  EXPECT_LT(log[2499].feed_ratio(), 0.6) << "it corrects again";
}

}  // namespace
}  // namespace steadyrest::scenarios
