// SPDX-License-Identifier: Apache-2.0
#include <algorithm>

#include <gtest/gtest.h>

#include <steadyrest/chatter/online/modulator.hpp>
#include <steadyrest/chatter/online/test/modulator_bench.hpp>

namespace steadyrest::chatter::online::test {
namespace {

using kernel::outcome::Reason;

// Clipped at 100 %, the sine would dwell there for half its period, and chatter grows in a dwell.
TEST(Modulator, BelowTheOperatorsSwitchTheWholeSwingMovesDown) {
  auto c = sine_config();
  c.spindle_table.layer_may_exceed_panel = false;
  Bench bench(c);
  bench.run(1.0);
  const auto all = ratios(bench.run(1.0));
  EXPECT_DOUBLE_EQ(*std::ranges::max_element(all), 1.0);
  EXPECT_DOUBLE_EQ(*std::ranges::min_element(all), 0.80);
  EXPECT_EQ(bench.cycle().spindle.reason, Reason::chatter_swing_narrowed);
}

// At 90 % speed a feed of 95 % would be 1.056 of the programmed chip, so the feed goes to 90 %.
TEST(Modulator, TheFeedFollowsTheSpindleDown) {
  auto c = sine_config();
  c.max_feed_per_tooth_ratio = 1.05;
  Bench bench(c);
  bench.run(1.0);
  double lowest_feed = 1.0;
  double lowest = 1.0;
  for (const auto& o : bench.run(1.0)) {
    EXPECT_LE(o.feed.ratio / o.spindle.ratio, 1.05 + 1e-9);
    lowest_feed = std::min(lowest_feed, o.feed.ratio);
    lowest = std::min(lowest, o.spindle.ratio);
  }
  EXPECT_DOUBLE_EQ(lowest, 0.90);
  EXPECT_DOUBLE_EQ(lowest_feed, 0.90);
}

TEST(Modulator, WhereTheFeedCannotFollowTheSwingEndsAtTheBand) {
  auto c = sine_config();
  c.max_feed_per_tooth_ratio = 1.05;
  c.feed_table = {};
  Bench bench(c);
  bench.run(1.0);
  double lowest = 1.0;
  for (const auto& o : bench.run(1.0)) {
    lowest = std::min(lowest, o.spindle.ratio);
    EXPECT_EQ(o.feed.ratio, 1.0);
  }
  EXPECT_DOUBLE_EQ(lowest, 1.0) << "0.95 would be 1.0526 of the programmed feed per tooth";
}

// The request is 100 %, but something holds the spindle override at 90 %.
TEST(Modulator, TheFeedKeepsToTheSpeedThatTheControlWasToldNotToTheOneAsked) {
  auto c = sine_config();
  c.modulation.law = Law::constant;
  c.max_feed_per_tooth_ratio = 1.0;
  Bench bench(c);
  EXPECT_EQ(bench.run(0.5).back().feed.ratio, 1.0);
  bench.in_force.spindle = {.ratio = 0.9, .word_ratio = 0.9};
  bench.frame.time_s += kCycle_s;
  EXPECT_EQ(bench.modulator.update(bench.frame, bench.in_force).spindle.ratio, 1.0);
  EXPECT_EQ(bench.modulator.update(bench.frame, bench.in_force).feed.ratio, 0.9);
}

// The feed request is down to 90 %, but its word is still at 100 %.
TEST(Modulator, TheSpindleWaitsForTheFeedThatTheControlWasToldNotForTheOneAsked) {
  auto c = sine_config();
  c.modulation.law = Law::constant;
  c.modulation.mean_ratio = 0.9;
  c.max_feed_per_tooth_ratio = 1.0;
  for (const double word_ratio : {0.9, 1.0}) {
    Bench bench(c);
    Modulator::Output out;
    for (int i = 0; i < 500; ++i) {
      out = bench.cycle();
      bench.in_force.feed = {.ratio = word_ratio, .word_ratio = word_ratio};
    }
    EXPECT_EQ(out.feed.ratio, 0.9);
    EXPECT_EQ(out.spindle.ratio, word_ratio);
  }
}

TEST(Modulator, FeedPerRevolutionIsLeftAlone) {
  auto c = sine_config();
  c.max_feed_per_tooth_ratio = 1.0;
  Bench bench(c);
  bench.frame.feed_per_revolution = true;
  bench.run(1.0);
  double lowest = 1.0;
  for (const auto& o : bench.run(1.0)) {
    EXPECT_EQ(o.feed.ratio, 1.0);
    lowest = std::min(lowest, o.spindle.ratio);
  }
  EXPECT_DOUBLE_EQ(lowest, 0.90);
}

// The feed cannot exceed 100 %, so 1/0.95 = 1.053 is the fastest spindle with enough chip.
TEST(Modulator, TheBandsLowerEndBoundsTheSwingUpwards) {
  auto c = sine_config();
  c.modulation.amplitude_ratio = 0.2;
  c.min_feed_per_tooth_ratio = 0.95;
  Bench bench(c);
  bench.run(1.0);
  for (const auto& o : bench.run(1.0)) {
    EXPECT_LE(o.spindle.ratio, 1.05 + 1e-9);
  }
}

}  // namespace
}  // namespace steadyrest::chatter::online::test
