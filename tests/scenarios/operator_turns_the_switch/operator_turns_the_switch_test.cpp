// SPDX-License-Identifier: Apache-2.0
// The operator turns the feed switch below and above the layer's word in the cut, and to a position
// that is not in the table.
#include <gtest/gtest.h>
#include <tests/scenarios/shared/stage.hpp>

namespace steadyrest::scenarios {
namespace {

using kernel::outcome::Reason;

/// In cycle n the machine's time is (n + 1)·4 ms.
constexpr double at_s(std::size_t cycle) {
  return 0.004 * static_cast<double>(cycle);
}

sim::OperatorAction turn(double time_s, std::uint32_t code) {
  return {.time_s = time_s, .act = sim::OperatorAct::turn_feed, .code = code};
}

TEST(OperatorTurnsTheSwitch, DownAtOnceUpByTheSlew) {
  const Stage tables;
  Stage stage({.operator_actions = {turn(at_s(1000), tables.feed_code(0.1)),
                                    turn(at_s(1300), tables.feed_code(1.0))}});
  stage.run(2000);
  const auto& log = stage.log();
  for (std::size_t i = 1010; i < 1290; ++i) {
    ASSERT_NEAR(log[i].frame.feed.panel_ratio, 0.1, 1e-9);
    ASSERT_LE(log[i].feed_ratio(), 0.1 + 1e-9);
  }
  EXPECT_EQ(log[1200].status.reasons[0], Reason::panel_lower);
  EXPECT_LT(log[1330].frame.feed.effective_ratio, 0.6) << "the layer's limit still holds";
  EXPECT_LT(log[1999].feed_ratio(), 0.6);
}

TEST(OperatorTurnsTheSwitch, ACodeThatIsNotInTheTableKeepsTheLastPanel) {
  Stage stage({.operator_actions = {turn(at_s(1000), 0b11111111)}});
  stage.run(1600);
  EXPECT_GT(stage.named(Reason::unknown_override_code, 1000, 1600), 590U);
  EXPECT_LE(stage.largest_rise(1000, 1600), 0.11) << "by the slew";
  EXPECT_FALSE(stage.log()[1599].masks()) << "a panel that is not known is not masked";
}

}  // namespace
}  // namespace steadyrest::scenarios
