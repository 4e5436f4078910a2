// SPDX-License-Identifier: Apache-2.0
// From each mode to each, with and without something of the layer on the machine.
#include <cmath>

#include <gtest/gtest.h>

#include <steadyrest/supervisor/test/bench.hpp>

namespace steadyrest::supervisor {
namespace {

using kernel::machine::Mode;
using test::Bench;

constexpr Mode kModes[] = {Mode::observe, Mode::advise, Mode::act};

// Neutral, there is nothing to hand back: the mode changes in the same cycle.
TEST(ModeChange, IsMadeAtOnceWhileTheLayerAsksForNothing) {
  for (const Mode from : kModes) {
    for (const Mode to : kModes) {
      Bench bench(from);
      EXPECT_EQ(bench.cycles(50).write, from == Mode::act);
      bench.supervisor.set_mode(to);
      EXPECT_EQ(bench.cycle().write, to == Mode::act);
      EXPECT_EQ(bench.supervisor.mode_in_force(), to);
    }
  }
}

// Rooms learn from what is in force; only what was written is.
TEST(ModeChange, OnlyInActIsWhatIsInForceWritten) {
  for (const Mode mode : kModes) {
    Bench bench(mode);
    bench.wish_feed(0.5);
    bench.cycles(200);
    EXPECT_EQ(bench.supervisor.in_force().written, mode == Mode::act);
  }
}

// Half-way back from 40 % the operator wants the layer again: the feed continues from there, at the
// slew of 10 1/s, and no cycle goes unwritten.
TEST(ModeChange, TurnedRoundOnTheWayBackItGoesOnFromThere) {
  Bench bench;
  bench.wish_feed(0.4);
  ASSERT_EQ(bench.cycles(200).feed_ratio, 0.4);
  bench.supervisor.set_mode(Mode::observe);
  ASSERT_EQ(bench.cycles(160).feed_ratio, 0.7);
  EXPECT_EQ(bench.supervisor.mode_in_force(), Mode::act);
  bench.supervisor.set_mode(Mode::act);
  double before = bench.supervisor.in_force().feed.ratio;
  for (int i = 0; i < 100; ++i) {
    EXPECT_TRUE(bench.cycle().write);
    const double now = bench.supervisor.in_force().feed.ratio;
    EXPECT_LE(before - now, 0.0101);
    before = now;
  }
  EXPECT_EQ(bench.cycle().feed_ratio, 0.4);
}

// The process was away for longer than the watchdog's 0.1 s and returns in observe: nothing of it
// is on the machine, so nothing is written, not even once.
TEST(ModeChange, WhatTheWatchdogHasDroppedIsNotHandedBackAnyMore) {
  Bench before;
  before.wish_feed(0.4);
  before.cycles(200);
  Bench after;
  after.frame = before.frame;
  after.supervisor.restore(before.supervisor.state());
  after.supervisor.set_mode(Mode::observe);
  after.frame.time_s += 60.0;
  for (int i = 0; i < 20; ++i) {
    const auto command = after.cycle();
    EXPECT_FALSE(command.write) << i;
    EXPECT_FALSE(command.feed_masks_panel) << i;
  }
  EXPECT_EQ(after.supervisor.mode_in_force(), Mode::observe);
}

// After a shorter absence the machine still holds the word; the slew brings it back to the panel.
TEST(ModeChange, WhatTheMachineStillHoldsIsHandedBackFirst) {
  Bench before;
  before.wish_feed(0.4);
  before.cycles(200);
  Bench after;
  after.frame = before.frame;
  after.supervisor.restore(before.supervisor.state());
  after.supervisor.set_mode(Mode::observe);
  const auto first = after.cycles(3);
  EXPECT_TRUE(first.write);
  EXPECT_EQ(first.feed_ratio, 0.4);
  EXPECT_EQ(after.cycles(400).feed_ratio, 1.0);
  EXPECT_EQ(after.supervisor.mode_in_force(), Mode::observe);
}

// All three are moving; the cycle that the port did not take must not have moved any of them.
TEST(Undelivered, NoneOfTheThreeHasMoved) {
  Bench bench;
  bench.wish_feed(0.4);
  bench.wish_spindle(0.8);
  bench.wish_offset(0.02);
  bench.cycles(40);
  const auto before = bench.supervisor.state();
  bench.cycle();
  const auto moved = bench.supervisor.state();
  ASSERT_LT(moved.feed.envelope.ratio, before.feed.envelope.ratio);
  ASSERT_LT(moved.spindle.envelope.ratio, before.spindle.envelope.ratio);
  ASSERT_GT(moved.offset.offset_mm[2], before.offset.offset_mm[2]);
  bench.supervisor.not_delivered();
  const auto after = bench.supervisor.state();
  EXPECT_EQ(after.feed.envelope.ratio, before.feed.envelope.ratio);
  EXPECT_EQ(after.spindle.envelope.ratio, before.spindle.envelope.ratio);
  EXPECT_EQ(after.offset.offset_mm, before.offset.offset_mm);
  EXPECT_EQ(after.delivered_s, before.delivered_s);
  EXPECT_TRUE(after.interrupted);
  EXPECT_FALSE(bench.supervisor.in_force().written);
}

}  // namespace
}  // namespace steadyrest::supervisor
