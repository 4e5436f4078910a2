// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>
#include <rapidcheck.h>
#include <rapidcheck/gtest.h>

#include <steadyrest/kernel/units/constants.hpp>
#include <steadyrest/supervisor/supervisor.hpp>
#include <steadyrest/supervisor/test/bench.hpp>

namespace steadyrest::supervisor {
namespace {

namespace machine = kernel::machine;
namespace signal = kernel::signal;
using kernel::machine::Mode;
using kernel::outcome::Reason;
using kernel::units::kInfinity;
using kernel::units::kNan;
using test::Bench;
using test::FakePort;
using test::kAll;
using test::mill;

// The default in the machine's values, not in a file: whoever forgets the mode must get observe.
TEST(Safety, ObserveIsTheDefaultAndWritesNothing) {
  EXPECT_EQ(machine::Machine{}.mode, Mode::observe);
  auto supervisor = Supervisor::make(mill(machine::Machine{}.mode), kAll);
  ASSERT_TRUE(supervisor);
  FakePort port;
  port.frame.feed.panel_ratio = 0.8;
  const std::vector<signal::FeedRequest> wish = {{.ratio = 0.2, .reason = Reason::contour_limit}};
  for (int i = 0; i < 500; ++i) {
    const auto command = supervisor->cycle(port, {.feed = wish, .spindle = {}, .offset = {}});
    ASSERT_TRUE(command);
    EXPECT_FALSE(command->write);
    EXPECT_FALSE(command->feed_masks_panel);
    EXPECT_EQ(command->feed_ratio, 0.8);
    EXPECT_EQ(command->feed_reason, Reason::observe_only);
  }
  EXPECT_TRUE(port.written.empty());
}

// Two supervisors on the same frames: one advises, one acts, and every word must be the same in
// every cycle. Advice that differs from what act would do is worthless.
TEST(Safety, AdviseShowsWhatActWouldWriteAndWritesNothing) {
  Bench advise(Mode::advise);
  Bench act(Mode::act);
  for (auto* bench : {&advise, &act}) {
    bench->wish_feed(0.3);
    bench->wish_spindle(0.9);
    bench->wish_offset(0.01);
  }
  for (int i = 0; i < 500; ++i) {
    const auto shown = advise.cycle();
    const auto written = act.cycle();
    EXPECT_FALSE(shown.write);
    EXPECT_TRUE(written.write);
    EXPECT_EQ(shown.feed_code, written.feed_code);
    EXPECT_EQ(shown.feed_masks_panel, written.feed_masks_panel);
    EXPECT_EQ(shown.spindle_code, written.spindle_code);
    EXPECT_EQ(shown.offset_mm, written.offset_mm);
  }
  EXPECT_EQ(act.cycle().feed_ratio, 0.3);
  EXPECT_EQ(act.cycle().spindle_ratio, 0.9);
  EXPECT_EQ(act.cycle().offset_mm[2], 0.01);
}

// In advise the word had walked down to 20 %. On the way to act it must begin at the panel and take
// its first step from there.
TEST(Safety, AdviceThatNeverStoodOnTheMachineIsNotTakenOver) {
  Bench bench(Mode::advise);
  bench.wish_feed(0.2);
  EXPECT_EQ(bench.cycles(500).feed_ratio, 0.2);
  bench.supervisor.set_mode(Mode::act);
  EXPECT_EQ(bench.cycle().feed_ratio, 1.0) << "the machine is at the panel's 100 %";
  EXPECT_EQ(bench.cycle().feed_ratio, 0.95);
}

// Expected: 0.6 of ratio at 2 1/s is 0.3 s; the offset is frozen while the tool cuts (1 s) and
// then takes 0.01 mm / 0.05 mm/s = 0.2 s; act ends after 1.2 s and not before.
TEST(Safety, LeavingActHandsBackThroughTheSlewBeforeItStopsWriting) {
  for (const Mode to : {Mode::observe, Mode::advise}) {
    Bench bench;
    bench.wish_feed(0.4);
    bench.wish_offset(0.01);
    bench.cycles(1000);
    bench.supervisor.set_mode(to);
    double in_force = 0.4;
    int writing = 0;
    for (int i = 0; i < 2000; ++i) {
      bench.frame.motion = i < 1000 ? signal::Motion::feed : signal::Motion::rapid;
      const auto command = bench.cycle();
      if (!command.write) {
        break;
      }
      ++writing;
      EXPECT_EQ(command.feed_reason, Reason::observe_only);
      EXPECT_LE(command.feed_ratio, in_force + 0.1 + 1e-9) << "no more than one step at once";
      in_force = command.feed_ratio;
      if (i == 290) {
        EXPECT_LT(in_force, 1.0) << "0.6 at 2 1/s takes 0.3 s";
      }
      if (i == 999) {
        EXPECT_EQ(command.offset_mm[2], 0.01) << "frozen in the cut";
      }
    }
    EXPECT_EQ(in_force, 1.0);
    EXPECT_NEAR(writing, 1200, 3) << "1 s in the cut, then 0.01 mm at 0.05 mm/s";
    EXPECT_EQ(bench.supervisor.mode_in_force(), to);
    EXPECT_FALSE(bench.cycles(1000).write);
  }
}

// Two laws for any history: nothing exceeds the panel, and nothing is written outside act.
RC_GTEST_PROP(Safety, WhateverComesInForceStaysUnderThePanelAndOnlyActWrites, ()) {
  const Mode mode = *rc::gen::element(Mode::observe, Mode::advise, Mode::act);
  Bench bench(mode);
  const int acts = *rc::gen::inRange(1, 20);
  for (int act = 0; act < acts; ++act) {
    bench.wish_feed(*rc::gen::element(0.0, 0.3, 0.77, 1.0, 1.2, kNan, -1.0, kInfinity, 7.0));
    bench.wish_spindle(*rc::gen::element(0.0, 0.5, 0.8, 1.1, kNan, kInfinity));
    bench.frame.feed.panel_ratio = *rc::gen::element(0.0, 0.5, 0.95, 1.0, 1.2);
    bench.frame.spindle.panel_ratio = *rc::gen::element(0.5, 0.9, 1.0, 1.2);
    bench.frame.motion = static_cast<signal::Motion>(*rc::gen::inRange(0, 9));
    bench.frame.age_s = *rc::gen::element(0.0, 0.0, 0.0, 1.0, kNan);
    if (*rc::gen::inRange(0, 5) == 0) {
      bench.supervisor.set_mode(*rc::gen::element(Mode::observe, Mode::advise, Mode::act));
    }
    const int cycles = *rc::gen::inRange(1, 80);
    for (int i = 0; i < cycles; ++i) {
      const auto command = bench.cycle();
      RC_ASSERT(command.write == (bench.supervisor.mode_in_force() == Mode::act));
      RC_ASSERT(command.feed_ratio <= bench.frame.feed.panel_ratio + 1e-8);
      RC_ASSERT(command.spindle_ratio <= bench.frame.spindle.panel_ratio + 1e-8);
      RC_ASSERT(bench.supervisor.mode_in_force() != Mode::observe || !command.feed_masks_panel);
    }
  }
}

}  // namespace
}  // namespace steadyrest::supervisor
