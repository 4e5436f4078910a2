// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include <steadyrest/kernel/override/channel.hpp>
#include <steadyrest/kernel/override/test/published_tables.hpp>

namespace steadyrest::kernel::override {
namespace {

using outcome::Reason;

// 34.9 % rounds down to 30 %, position 9 of the switch: Gray 01101.
TEST(Channel, AskedForASteadyWishItStandsOnTheLargestStepBelow) {
  auto channel = Channel::make({.table = test::feed_840d()});
  ASSERT_TRUE(channel);
  RatioEnvelope::Input input{.ratio = 0.349, .reason = Reason::contour_limit};
  input.panel.panel_code = 0b11010;
  Channel::Output output;
  for (int ms = 0; ms < 200; ++ms) {
    input.step_s = 0.001;
    output = channel->update(input);
  }
  EXPECT_TRUE(output.masks_panel);
  EXPECT_EQ(output.ratio, 0.30);
  EXPECT_EQ(output.code, 0b01101U);
  EXPECT_EQ(output.reason, Reason::contour_limit);
}

// The fault that the machine file exists for: 11010 is 100 % on the 840D panel, 70 % here.
TEST(Channel, OnTheDmgTableTheWordForSeventyPercentIsTheOneThatElsewhereMeansHundred) {
  auto channel = Channel::make({.table = test::feed_dmg()});
  ASSERT_TRUE(channel);
  RatioEnvelope::Input input{.ratio = 0.7, .reason = Reason::contour_limit};
  Channel::Output output;
  for (int ms = 0; ms < 200; ++ms) {
    input.step_s = 0.001;
    output = channel->update(input);
  }
  EXPECT_EQ(output.ratio, 0.7);
  EXPECT_EQ(output.code, 0b11010U);
}

TEST(Channel, TheLowerLimitIsAStepOfTheTable) {
  // 25 % lies between 20 and 30: rounding down must not end below the limit.
  auto channel = Channel::make({.table = test::feed_840d(), .min_ratio = 0.25});
  ASSERT_TRUE(channel);
  RatioEnvelope::Input input{.ratio = 0.0, .reason = Reason::contour_limit};
  Channel::Output output;
  for (int ms = 0; ms < 500; ++ms) {
    input.step_s = 0.001;
    output = channel->update(input);
  }
  EXPECT_EQ(output.ratio, 0.30);
  EXPECT_EQ(output.reason, Reason::clamped);
}

TEST(Channel, WhereThePortCannotWriteTheReasonSaysSo) {
  auto channel = Channel::make({.table = test::feed_840d(), .available = false});
  ASSERT_TRUE(channel);
  RatioEnvelope::Input input{.ratio = 0.3, .reason = Reason::contour_limit};
  Channel::Output output;
  for (int ms = 0; ms < 500; ++ms) {
    input.step_s = 0.001;
    output = channel->update(input);
  }
  EXPECT_FALSE(output.masks_panel);
  EXPECT_EQ(output.ratio, 1.0);
  EXPECT_EQ(output.reason, Reason::port_cannot_write);
}

TEST(Channel, RefusesATableThatTheEnvelopeExcludes) {
  const auto channel = Channel::make({.table = test::spindle_840d(), .max_ratio = 0.4});
  ASSERT_FALSE(channel);
  EXPECT_EQ(channel.error().what, "the override table has no step within the envelope's 0 … 40 %");
}

// At 90 ms the walk is under way: step, scan and mask must carry over.
TEST(Channel, ARestoredStateGoesOnWhereItWas) {
  const Channel::Config config{.table = test::feed_840d(), .latched = false};
  auto first = Channel::make(config);
  auto second = Channel::make(config);
  ASSERT_TRUE(first);
  ASSERT_TRUE(second);
  RatioEnvelope::Input input{.ratio = 0.3, .reason = Reason::contour_limit};
  for (int ms = 0; ms < 90; ++ms) {
    input.step_s = 0.001;
    first->update(input);
  }
  second->restore(first->state());
  for (int ms = 90; ms < 300; ++ms) {
    input.step_s = 0.001;
    const auto a = first->update(input);
    const auto b = second->update(input);
    ASSERT_EQ(a.code, b.code);
    ASSERT_EQ(a.masks_panel, b.masks_panel);
  }
}

}  // namespace
}  // namespace steadyrest::kernel::override
