// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include <steadyrest/kernel/override/channel.hpp>
#include <steadyrest/kernel/override/test/cycle.hpp>
#include <steadyrest/kernel/override/test/published_tables.hpp>

namespace steadyrest::kernel::override {
namespace {

using outcome::Reason;
using test::kCycle_s;

/// A channel asked for 50 % with the panel at 100 %; it falls by 10 1/s.
class Asked {
 public:
  Asked() : channel(Channel::make({.table = test::feed_840d()}).value()) {
    input.panel.panel_code = 0b11010;
    input.ratio = 0.5;
    input.reason = Reason::contour_limit;
  }
  Channel::Output cycles(int count) {
    Channel::Output out;
    for (int i = 0; i < count; ++i) {
      input.step_s = kCycle_s;
      out = channel.update(input);
    }
    return out;
  }

  Channel channel;
  RatioEnvelope::Input input;
};

// In each cycle of the fall the word is the step below the ratio, and no cycle drops by more than
// 10 1/s · 1 ms.
TEST(ChannelInForce, IsWhatWasLetThroughNotWhatWasAskedFor) {
  Asked asked;
  double before = 1.0;
  for (int i = 0; i < 100; ++i) {
    const auto out = asked.cycles(1);
    const auto in_force = asked.channel.in_force();
    EXPECT_EQ(in_force.word_ratio, out.ratio);
    EXPECT_GE(in_force.ratio, in_force.word_ratio - kRatioTolerance)
        << "the word is the step below";
    EXPECT_LE(before - in_force.ratio, 10.0 * kCycle_s + 1e-12);
    before = in_force.ratio;
  }
  EXPECT_EQ(before, 0.5);
  EXPECT_EQ(asked.channel.in_force().word_ratio, 0.5);
}

TEST(ChannelInForce, IsThePanelsWhereTheOperatorTurnsDown) {
  Asked asked;
  asked.cycles(100);
  asked.input.panel.panel_ratio = 0.2;
  asked.cycles(1);
  EXPECT_EQ(asked.channel.in_force().ratio, 0.2);
  EXPECT_EQ(asked.channel.in_force().word_ratio, 0.2);
}

// take_back() must undo the last cycle's fall, in ratio and in word.
TEST(ChannelInForce, ACommandThatWasNotDeliveredIsNotInForce) {
  Asked asked;
  asked.cycles(20);
  const auto before = asked.channel.state();
  const auto in_force = asked.channel.in_force();
  asked.cycles(1);
  EXPECT_LT(asked.channel.in_force().ratio, in_force.ratio);
  asked.channel.take_back(before);
  EXPECT_EQ(asked.channel.in_force().ratio, in_force.ratio);
  EXPECT_EQ(asked.channel.in_force().word_ratio, in_force.word_ratio);
}

TEST(ChannelInForce, IsThePanelsWhereThePortCannotWrite) {
  Asked asked;
  asked.channel =
      Channel::make({.table = test::feed_840d(), .latched = true, .available = false}).value();
  asked.cycles(100);
  EXPECT_EQ(asked.channel.in_force().ratio, 1.0);
  EXPECT_EQ(asked.channel.in_force().word_ratio, 1.0);
}

TEST(ChannelInForce, HoldsInAThread) {
  Asked asked;
  asked.cycles(20);
  const auto in_force = asked.channel.in_force();
  asked.input.hold = true;
  asked.cycles(100);
  EXPECT_EQ(asked.channel.in_force().ratio, in_force.ratio);
}

TEST(ChannelInForce, IsThePanelsWhileNothingIsWritten) {
  Asked asked;
  asked.channel.see_panel({.panel_ratio = 0.7});
  EXPECT_EQ(asked.channel.in_force().ratio, 0.7);
  EXPECT_EQ(asked.channel.in_force().word_ratio, 0.7);
}

// The layer has a wish with the panel at 0, held by a thread; as the thread ends the operator turns
// down. No time has passed for the wish, so the operator's setting stays in force.
TEST(ChannelInForce, BeginsAtThePanelAsTheOperatorHasTurnedItWhileNoMaskWasOn) {
  auto table = test::feed_840d();
  table.layer_may_exceed_panel = true;
  auto channel = Channel::make({.table = table, .latched = true}).value();
  RatioEnvelope::Input input;
  input.ratio = 0.0;
  input.reason = Reason::contour_limit;
  input.panel = {.panel_ratio = 0.0, .panel_code_known = true};
  channel.update(input);
  input.panel.panel_ratio = 1.0;
  input.hold = true;
  channel.update(input);
  input.panel.panel_ratio = 0.5;
  input.hold = false;
  input.unfit = Reason::input_stale;
  EXPECT_EQ(channel.update(input).ratio, 0.5);
}

}  // namespace
}  // namespace steadyrest::kernel::override
