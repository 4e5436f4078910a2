// SPDX-License-Identifier: Apache-2.0
// Faults of time, modes, threads and aborts: review findings as tests.
#include <gtest/gtest.h>

#include <steadyrest/kernel/units/constants.hpp>
#include <steadyrest/supervisor/supervisor.hpp>
#include <steadyrest/supervisor/test/bench.hpp>

namespace steadyrest::supervisor {
namespace {

namespace signal = kernel::signal;
using kernel::machine::Mode;
using kernel::units::kInfinity;
using kernel::units::kNan;
using test::Bench;
using test::kCycle_s;
using test::wired;

// Twenty wrong stamps among good ones. By cycle k real time allows a rise of 2·T·k and an offset
// of 0.05·T·k, whatever the stamps claim.
TEST(Interruption, AWrongTimeStampGivesNoCreditToAnySlew) {
  for (const double wrong_s :
       {-1.0, -1e6, -0.05, 0.05, 0.15, 5.0, 1e9, kNan, kInfinity, -kInfinity}) {
    Bench bench;
    bench.wish_feed(0.4);
    bench.wish_offset(0.0);
    bench.cycles(500);
    bench.wish_feed(1.0);
    bench.wish_offset(0.1);
    for (int k = 1; k <= 20; ++k) {
      auto glitch = bench.frame;
      glitch.time_s += kCycle_s + wrong_s;
      auto command = bench.supervisor.update(
          glitch, {.feed = bench.feed, .spindle = bench.spindle, .offset = bench.offset});
      EXPECT_LE(command.feed_ratio, 0.4 + 2.0 * kCycle_s * k + 1e-9) << wrong_s;
      command = bench.cycle();
      EXPECT_LE(command.feed_ratio, 0.4 + 2.0 * kCycle_s * k + 1e-9) << wrong_s;
      EXPECT_LE(command.offset_mm[2], 0.05 * kCycle_s * k + 1e-9) << wrong_s;
    }
    EXPECT_GT(bench.cycles(100).feed_ratio, 0.55) << wrong_s << ": the slew goes on";
  }
}

// A word must be on the wires for one scan (20 ms) before a mask may point at it. Advice never was
// on them.
TEST(Interruption, WordsThatWereOnlyAdvisedHaveNotSettledInAct) {
  for (const bool may_exceed : {false, true}) {
    Bench bench(wired(Mode::advise, may_exceed));
    if (may_exceed) {
      bench.wish_feed(1.2);
    }
    bench.cycles(500);
    bench.supervisor.set_mode(Mode::act);
    bench.wish_feed(0.5);
    for (int ms = 0; ms < 20; ++ms) {
      const auto command = bench.cycle();
      EXPECT_TRUE(command.write);
      EXPECT_FALSE(command.feed_masks_panel) << ms << " ms after the first write";
      EXPECT_EQ(command.feed_code, 0b11010U) << "the panel's own step, from the first write on";
    }
    EXPECT_TRUE(bench.cycles(2).feed_masks_panel);
  }
}

// A stamp without a valid time proves no scan.
TEST(Interruption, AFrameWithoutTimeSettlesNoWord) {
  Bench bench(wired(Mode::act));
  bench.wish_feed(0.5);
  bench.frame.feed.panel_ratio = 0.0;
  bench.cycles(100);
  bench.frame.feed.panel_ratio = 0.95;
  for (const double time_s : {kInfinity, kNan, -kInfinity, 0.0}) {
    auto glitch = bench.frame;
    glitch.time_s = time_s;
    const auto command =
        bench.supervisor.update(glitch, {.feed = bench.feed, .spindle = {}, .offset = {}});
    EXPECT_FALSE(command.feed_masks_panel) << time_s;
  }
}

// A control that boots starts its clock at 0; a simulator may also go back. Words that waited for
// an absolute time would never settle again.
TEST(Interruption, AClockThatBeginsAgainBlocksNoMask) {
  Bench bench(wired(Mode::act));
  bench.frame.time_s = 1000.0;
  bench.wish_feed(0.5);
  EXPECT_EQ(bench.cycles(500).feed_ratio, 0.5);
  bench.frame.time_s = 0.0;
  bench.feed.clear();
  EXPECT_FALSE(bench.cycles(1000).feed_masks_panel) << "handed back";
  bench.frame.time_s = -500.0;
  bench.wish_feed(0.3);
  EXPECT_EQ(bench.cycles(1000).feed_ratio, 0.3) << "and taken over";
  bench.frame.time_s = -900.0;
  bench.supervisor.set_mode(Mode::observe);
  bench.cycles(1000);
  EXPECT_EQ(bench.supervisor.mode_in_force(), Mode::observe);
}

// A frame without a valid time never tells how long the process was away.
TEST(Interruption, ARestoreWithoutTimeWritesNothing) {
  Bench first;
  first.wish_offset(0.02);
  first.cycles(1000);
  Bench second;
  second.frame = first.frame;
  second.supervisor.restore(first.supervisor.state());
  auto frame = second.frame;
  frame.time_s = kNan;
  for (int i = 0; i < 50; ++i) {
    const auto command = second.supervisor.update(frame);
    EXPECT_FALSE(command.write);
    EXPECT_EQ(command.offset_mm[2], 0.0);
  }
}

// The spindle may rise at 10 1/s, so that the walking word lags behind the envelope: the tap begins
// with a step under way, and the hold applies to the word on the wires.
TEST(Interruption, AWordHoldsInTheMiddleOfItsWalkInATap) {
  auto machine = wired(Mode::act);
  machine.envelope.spindle_slew_1_s = 10.0;
  Bench bench(machine);
  bench.cycles(100);
  bench.wish_spindle(0.6);
  double before = 1.0;
  while (before > 0.81) {
    before = bench.cycle().spindle_ratio;
  }
  bench.frame.motion = signal::Motion::tap;
  EXPECT_EQ(bench.cycles(500).spindle_ratio, before);
  bench.frame.motion = signal::Motion::feed;
  EXPECT_EQ(bench.cycles(500).spindle_ratio, 0.6);
}

// A thousand cycles are five times what a hand-over takes. Unfit input, other modes, other wishes,
// no link: only a fit frame that shows another motion ends the hold.
TEST(Interruption, ATapHoldsWhateverTheInputDoesUntilAFitFrameShowsItsEnd) {
  using SpoilBench = void (*)(Bench&);
  const SpoilBench spoils[] = {
      [](Bench& b) { b.frame.axis[0].following_error_mm = kNan; },
      [](Bench& b) { b.frame.age_s = 9.0; }, [](Bench& b) { b.frame.axis_count = 200; },
      [](Bench& b) { b.frame.feed.panel_code_known = b.frame.spindle.panel_code_known = false; },
      [](Bench& b) { b.supervisor.set_mode(Mode::observe); },
      [](Bench& b) { b.supervisor.set_mode(Mode::advise); },
      [](Bench& b) { b.feed.clear(), b.spindle.clear(); },
      [](Bench& b) { b.wish_feed(kNan), b.wish_spindle(kNan); },
      // An unfit frame that shows a cut does not prove that the tap is over.
      [](Bench& b) { b.frame.motion = signal::Motion::feed, b.frame.age_s = 9.0; }};
  for (const SpoilBench spoil : spoils) {
    Bench bench;
    bench.wish_feed(0.6);
    bench.wish_spindle(0.8);
    bench.cycles(500);
    bench.frame.motion = signal::Motion::tap;
    bench.cycles(10);
    spoil(bench);
    for (int i = 0; i < 1000; ++i) {
      const auto command = bench.cycle();
      ASSERT_EQ(command.feed_ratio, 0.6) << &spoil - spoils;
      ASSERT_EQ(command.spindle_ratio, 0.8) << &spoil - spoils;
      ASSERT_TRUE(command.write);
    }
    double time_s = bench.frame.time_s;
    for (int i = 0; i < 1000; ++i) {
      time_s += kCycle_s;
      ASSERT_EQ(bench.supervisor.update_without_frame(time_s).feed_ratio, 0.6) << "lost link";
    }
  }
}

TEST(Interruption, AnUnfitFrameThatShowsATapHoldsToo) {
  Bench bench;
  bench.wish_feed(0.6);
  bench.cycles(500);
  bench.frame.motion = signal::Motion::tap;
  bench.frame.age_s = 9.0;
  EXPECT_EQ(bench.cycles(1000).feed_ratio, 0.6);
  bench.frame.motion = signal::Motion::feed;
  EXPECT_EQ(bench.cycles(1000).feed_ratio, 1.0) << "handed back once nothing shows a tap";
}

// Idle for 1 s means that the tool is out; the fade begins then: 0.2 s later 0.01 mm of 0.02 are
// left.
TEST(Interruption, AfterAnAbortTheOffsetFades) {
  Bench bench;
  bench.wish_offset(0.02);
  bench.cycles(1000);
  bench.frame.motion = signal::Motion::idle;
  bench.supervisor.set_mode(Mode::observe);
  EXPECT_EQ(bench.cycles(900).offset_mm[2], 0.02) << "between two blocks a control is idle too";
  EXPECT_NEAR(bench.cycles(300).offset_mm[2], 0.01, 1e-4) << "0.05 mm/s from 1 s of idle on";
  EXPECT_FALSE(bench.cycles(400).write);
  EXPECT_EQ(bench.supervisor.mode_in_force(), Mode::observe);
}

// Short idles between blocks and long dwells, ten times over, must not add up to a second.
TEST(Interruption, ADwellOrAShortIdleInTheCutKeepsTheOffset) {
  Bench bench;
  bench.wish_offset(0.02);
  bench.cycles(1000);
  bench.offset.clear();
  for (int i = 0; i < 10; ++i) {
    bench.frame.motion = signal::Motion::idle;
    bench.cycles(500);
    bench.frame.motion = signal::Motion::feed;
    bench.cycles(10);
    bench.frame.motion = signal::Motion::dwell;
    EXPECT_EQ(bench.cycles(2000).offset_mm[2], 0.02);
  }
}

// The same after a restore: nothing may be written without a valid time, but the panel's 0 counts.
TEST(Interruption, ThePanelIsSeenWhileTimeIsNotKnown) {
  Bench first;
  first.wish_feed(0.5);
  ASSERT_TRUE(first.cycles(1000).feed_masks_panel);
  Bench second;
  second.wish_feed(0.5);
  second.frame = first.frame;
  second.supervisor.restore(first.supervisor.state());
  auto frame = second.frame;
  frame.time_s = kNan;
  frame.feed.panel_ratio = 0.0;
  EXPECT_FALSE(second.supervisor.update(frame).write);
  second.frame.feed.panel_code_known = false;
  const auto command = second.cycle();
  EXPECT_TRUE(command.write);
  EXPECT_FALSE(command.feed_masks_panel);
}

}  // namespace
}  // namespace steadyrest::supervisor
