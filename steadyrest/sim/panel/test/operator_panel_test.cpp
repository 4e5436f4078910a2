// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include <steadyrest/sim/panel/operator_panel.hpp>

namespace steadyrest::sim {
namespace {

const OperatorPanel::State kStart{.feed_code = 19, .rapid_code = 19, .spindle_code = 11};

TEST(OperatorPanel, IsAsTheMachineWasSwitchedOnUntilTheFirstAction) {
  OperatorPanel panel(kStart, {{.time_s = 1.0, .act = OperatorAct::turn_feed, .code = 5}});
  const auto& state = panel.update(0.999);
  EXPECT_EQ(state.feed_code, 19U);
  EXPECT_FALSE(state.feed_hold);
  EXPECT_EQ(panel.update(1.0).feed_code, 5U);
}

TEST(OperatorPanel, EachSwitchHasItsOwnAct) {
  OperatorPanel panel(kStart, {{.time_s = 1.0, .act = OperatorAct::turn_feed, .code = 1},
                               {.time_s = 2.0, .act = OperatorAct::turn_rapid, .code = 2},
                               {.time_s = 3.0, .act = OperatorAct::turn_spindle, .code = 3},
                               {.time_s = 4.0, .act = OperatorAct::feed_hold},
                               {.time_s = 5.0, .act = OperatorAct::feed_start}});
  const auto expect = [&](double time_s, std::uint32_t feed, std::uint32_t rapid,
                          std::uint32_t spindle, bool hold) {
    const auto& state = panel.update(time_s);
    EXPECT_EQ(state.feed_code, feed) << time_s;
    EXPECT_EQ(state.rapid_code, rapid) << time_s;
    EXPECT_EQ(state.spindle_code, spindle) << time_s;
    EXPECT_EQ(state.feed_hold, hold) << time_s;
  };
  expect(1.5, 1, 19, 11, false);
  expect(2.5, 1, 2, 11, false);
  expect(3.5, 1, 2, 3, false);
  expect(4.5, 1, 2, 3, true);
  expect(5.5, 1, 2, 3, false);
}

// Scripts are written in any order; time decides.
TEST(OperatorPanel, ActsInTheOrderOfTime) {
  OperatorPanel panel(kStart, {{.time_s = 3.0, .act = OperatorAct::turn_feed, .code = 3},
                               {.time_s = 1.0, .act = OperatorAct::turn_feed, .code = 1},
                               {.time_s = 2.0, .act = OperatorAct::turn_feed, .code = 2}});
  EXPECT_EQ(panel.update(1.0).feed_code, 1U);
  EXPECT_EQ(panel.update(2.0).feed_code, 2U);
  EXPECT_EQ(panel.update(9.0).feed_code, 3U);
}

TEST(OperatorPanel, OfSimultaneousActsTheLastGivenStays) {
  OperatorPanel panel(kStart, {{.time_s = 1.0, .act = OperatorAct::turn_feed, .code = 7},
                               {.time_s = 1.0, .act = OperatorAct::feed_hold},
                               {.time_s = 1.0, .act = OperatorAct::turn_feed, .code = 8},
                               {.time_s = 1.0, .act = OperatorAct::feed_start}});
  const auto& state = panel.update(1.0);
  EXPECT_EQ(state.feed_code, 8U);
  EXPECT_FALSE(state.feed_hold);
}

// A late call misses nothing, and nothing acts twice: what the layer sees after a pause is the
// panel as the operator left it.
TEST(OperatorPanel, CatchesUpAfterAPause) {
  OperatorPanel panel(kStart, {{.time_s = 1.0, .act = OperatorAct::feed_hold},
                               {.time_s = 2.0, .act = OperatorAct::turn_spindle, .code = 4},
                               {.time_s = 3.0, .act = OperatorAct::feed_start}});
  const auto& state = panel.update(100.0);
  EXPECT_FALSE(state.feed_hold);
  EXPECT_EQ(state.spindle_code, 4U);
  EXPECT_EQ(panel.update(0.5).spindle_code, 4U);
}

}  // namespace
}  // namespace steadyrest::sim
