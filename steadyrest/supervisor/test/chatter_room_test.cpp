// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include <steadyrest/kernel/rt/testing/allocation_guard.hpp>
#include <steadyrest/supervisor/test/bench.hpp>

namespace steadyrest::supervisor::test {
namespace {

/// A spindle at 3000 rpm whose mean the modulator sets to 80 %, which would give 125 % of the feed
/// per tooth; the band brings the feed down to 90 %.
machine::Machine modulated(Mode mode = Mode::act) {
  auto m = mill(mode);
  m.chatter.enabled = true;
  m.chatter.law = machine::SpeedLaw::constant;
  m.chatter.mean_ratio = 0.8;
  m.chatter.max_feed_per_tooth_ratio = 1.125;
  m.chatter.m_code_on = m.chatter.m_code_off = 0;
  return m;
}

struct ChatterBench : Bench {
  explicit ChatterBench(const machine::Machine& m = modulated()) : Bench(m) {
    frame.programmed_feed_mm_s = 10.0;
    frame.spindle_programmed_rev_s = 50.0;
    frame.spindle_actual_rev_s = 50.0;
    frame.spindle.panel_code = 0b01110;
  }
  /// The machine executes at once what is written.
  signal::Command run(int count) {
    signal::Command command;
    for (int i = 0; i < count; ++i) {
      command = cycle();
      frame.feed.effective_ratio =
          command.write && command.feed_masks_panel ? command.feed_ratio : 1.0;
      frame.spindle.effective_ratio =
          command.write && command.spindle_masks_panel ? command.spindle_ratio : 1.0;
      frame.spindle_actual_rev_s = 50.0 * frame.spindle.effective_ratio;
    }
    return command;
  }
};

// Closed form: at a speed ratio of 0.80 the feed per tooth is 1/0.80 = 1.25 times the programmed
// one; the band allows 1.125, so the feed must fall to 0.80 · 1.125 = 0.90.
TEST(ChatterRoom, BringsSpindleAndFeedOntoTheMachine) {
  ChatterBench bench;
  const auto command = bench.run(2000);
  EXPECT_EQ(command.spindle_ratio, 0.80);
  EXPECT_TRUE(command.spindle_masks_panel);
  EXPECT_EQ(command.spindle_reason, Reason::chatter_modulating);
  EXPECT_EQ(command.feed_ratio, 0.90);
  EXPECT_EQ(command.feed_reason, Reason::chatter_feed_follows);
  ASSERT_TRUE(bench.supervisor.estimates().chatter);
  EXPECT_EQ(bench.supervisor.estimates().chatter->fade, 1.0);
}

// The contour's 50 % is below the chatter room's 90 % and wins; its 95 % is above and loses.
TEST(ChatterRoom, OfTheRoomsFeedsTheLowestWins) {
  ChatterBench bench;
  bench.wish_feed(0.5);
  auto command = bench.run(2000);
  EXPECT_EQ(command.feed_ratio, 0.5);
  EXPECT_EQ(command.feed_reason, Reason::contour_limit);
  bench.wish_feed(0.95);
  command = bench.run(2000);
  EXPECT_EQ(command.feed_ratio, 0.90);
  EXPECT_EQ(command.feed_reason, Reason::chatter_feed_follows);
}

TEST(ChatterRoom, ObserveAndAdviseWriteNothing) {
  for (const Mode mode : {Mode::observe, Mode::advise}) {
    ChatterBench bench(modulated(mode));
    const auto command = bench.run(2000);
    EXPECT_FALSE(command.write);
    EXPECT_TRUE(bench.supervisor.estimates().chatter);
  }
}

// From the very first cycle, without the slew: a stop is no correction.
TEST(ChatterRoom, ThePanelAtZeroStops) {
  ChatterBench bench;
  bench.run(1000);
  bench.frame.feed.panel_ratio = 0.0;
  bench.frame.feed.panel_code = 0b00001;
  EXPECT_EQ(bench.run(1).feed_ratio, 0.0);
  EXPECT_EQ(bench.run(100).feed_ratio, 0.0);
}

// 2 s are more than 0.2 needs at any slew: both masks must be off, not merely neutral.
TEST(ChatterRoom, StaleInputHandsBack) {
  ChatterBench bench;
  bench.run(2000);
  bench.frame.age_s = 1.0;
  const auto command = bench.run(2000);
  EXPECT_FALSE(command.spindle_masks_panel);
  EXPECT_FALSE(command.feed_masks_panel);
  EXPECT_EQ(command.spindle_reason, Reason::input_stale);
}

// Reason none, not port_cannot_write: the room is off, so there is no wish.
TEST(ChatterRoom, SwitchedOffOrWithoutASwitchItAsksForNothing) {
  auto off = modulated();
  off.chatter.enabled = false;
  ChatterBench bench(off);
  EXPECT_FALSE(bench.run(500).spindle_masks_panel);
  EXPECT_FALSE(bench.supervisor.estimates().chatter);
  auto none = modulated();
  none.spindle_override = {};
  ChatterBench without(none);
  EXPECT_EQ(without.run(500).spindle_reason, Reason::none);
}

// Only 100 % itself lies within 0.98 … 1.02 of the speed: nothing to modulate with. With the room
// off, the same settings do no harm.
TEST(ChatterRoom, SettingsThatTheRoomRefusesAreTheSupervisorsRefusal) {
  auto m = modulated();
  m.envelope.min_spindle_ratio = 0.98;
  m.envelope.max_spindle_ratio = 1.02;
  EXPECT_FALSE(Supervisor::make(m, kAll));
  m.chatter.enabled = false;
  EXPECT_TRUE(Supervisor::make(m, kAll));
}

TEST(ChatterRoom, ACycleAllocatesNothing) {
  ChatterBench bench;
  bench.run(10);
  const kernel::rt::testing::AllocationGuard guard;
  bench.run(500);
}

}  // namespace
}  // namespace steadyrest::supervisor::test
