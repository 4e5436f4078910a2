// SPDX-License-Identifier: Apache-2.0
#include <cstdint>

#include <gtest/gtest.h>

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
using test::kAll;
using test::kCycle_s;
using test::mill;

TEST(Safety, TheLowestWishOfAllRoomsIsWritten) {
  Bench bench;
  bench.feed = {{signal::Room::motion, 0.8, Reason::contour_objective},
                {signal::Room::contour, 0.5, Reason::contour_limit},
                {signal::Room::thermal, 1.0, Reason::none}};
  const auto command = bench.cycles(200);
  EXPECT_EQ(command.feed_ratio, 0.5);
  EXPECT_EQ(command.feed_reason, Reason::contour_limit);
}

// One fault each, with the reason that it must give: what a broken link, a wrong configuration or a
// stopped sender looks like.
struct Spoil {
  const char* what;
  Reason reason;
  void (*spoil)(signal::Frame&);
};

const Spoil kSpoils[] = {
    {"age", Reason::input_stale, [](signal::Frame& f) { f.age_s = 0.11; }},
    {"age NaN", Reason::input_not_finite, [](signal::Frame& f) { f.age_s = kNan; }},
    {"age from the future", Reason::input_out_of_range, [](signal::Frame& f) { f.age_s = -5.0; }},
    {"command", Reason::input_not_finite, [](signal::Frame& f) { f.axis[1].command_mm = kNan; }},
    {"actual", Reason::input_not_finite,
     [](signal::Frame& f) { f.axis[2].actual_mm = -kInfinity; }},
    {"following error", Reason::input_not_finite,
     [](signal::Frame& f) { f.axis[0].following_error_mm = kInfinity; }},
    {"feed", Reason::input_not_finite, [](signal::Frame& f) { f.programmed_feed_mm_s = kNan; }},
    {"negative feed", Reason::input_out_of_range,
     [](signal::Frame& f) { f.programmed_feed_mm_s = -1.0; }},
    {"path speed", Reason::input_not_finite, [](signal::Frame& f) { f.path_speed_mm_s = kNan; }},
    {"spindle", Reason::input_not_finite, [](signal::Frame& f) { f.spindle_actual_rev_s = kNan; }},
    {"axis count", Reason::input_out_of_range, [](signal::Frame& f) { f.axis_count = 200; }},
    {"off the machine", Reason::input_out_of_range,
     [](signal::Frame& f) { f.axis[0].actual_mm = 1e9; }},
    {"panel", Reason::input_not_finite, [](signal::Frame& f) { f.feed.panel_ratio = kNan; }},
    {"negative panel", Reason::input_out_of_range,
     [](signal::Frame& f) { f.feed.panel_ratio = -0.5; }},
    {"panel code", Reason::unknown_override_code,
     [](signal::Frame& f) { f.feed.panel_code_known = false; }},
};

// No fault may jump: the first cycle still holds 0.4, the panel comes back at 2 1/s, and only then
// does the mask come off.
TEST(Safety, UnfitInputGivesTheNeutralRequestWithAReasonThroughTheSlew) {
  for (const auto& [what, reason, spoil] : kSpoils) {
    Bench bench;
    bench.wish_feed(0.4);
    ASSERT_EQ(bench.cycles(500).feed_ratio, 0.4) << what;
    spoil(bench.frame);
    auto command = bench.cycle();
    EXPECT_EQ(command.feed_reason, reason) << what;
    EXPECT_EQ(command.feed_ratio, 0.4) << what << ": no jump";
    EXPECT_LT(bench.cycles(290).feed_ratio, 1.0) << what << ": 0.6 at 2 1/s takes 0.3 s";
    command = bench.cycles(50);
    EXPECT_EQ(command.feed_ratio, 1.0) << what;
    EXPECT_FALSE(command.feed_masks_panel) << what;
    EXPECT_TRUE(command.write) << what;
  }
}

// One stamp back is unfit. A second one that follows it shows that the clock was set.
TEST(Safety, TimeThatRunsBackwardsOrIsNoTimeIsUnfit) {
  Bench bench;
  bench.wish_feed(0.4);
  bench.cycles(500);
  bench.frame.time_s -= 0.2;
  EXPECT_EQ(bench.cycle().feed_reason, Reason::input_out_of_range);
  EXPECT_EQ(bench.cycle().feed_reason, Reason::contour_limit) << "from here on it runs again";
  auto nan_frame = bench.frame;
  nan_frame.time_s = kNan;
  const auto command = bench.supervisor.update(nan_frame);
  EXPECT_EQ(command.feed_reason, Reason::input_not_finite);
  EXPECT_EQ(command.feed_ratio, 0.4);
}

// The channels are independent: a broken spindle switch is no reason to release the contour.
TEST(Safety, ABadSpindlePanelDoesNotWithdrawTheFeed) {
  Bench bench;
  bench.wish_feed(0.4);
  bench.wish_spindle(0.8);
  bench.cycles(500);
  bench.frame.spindle.panel_code_known = false;
  const auto command = bench.cycles(500);
  EXPECT_EQ(command.feed_ratio, 0.4);
  EXPECT_EQ(command.spindle_ratio, 1.0);
  EXPECT_EQ(command.spindle_reason, Reason::unknown_override_code);
}

// 100 ms without a frame are `stale_after`, then 0.3 s of slew; 700 ms are enough for both. Never
// having read a frame counts as stale too.
TEST(Safety, LostFramesBecomeStaleAndHandBack) {
  Bench bench;
  bench.wish_feed(0.4);
  bench.cycles(500);
  signal::Command command;
  double time_s = bench.frame.time_s;
  for (int i = 0; i < 100; ++i) {
    time_s += kCycle_s;
    command = bench.supervisor.update_without_frame(time_s);
  }
  EXPECT_LT(command.feed_ratio, 1.0);
  for (int i = 0; i < 600; ++i) {
    time_s += kCycle_s;
    command = bench.supervisor.update_without_frame(time_s);
  }
  EXPECT_EQ(command.feed_reason, Reason::input_stale);
  EXPECT_EQ(command.feed_ratio, 1.0);
  EXPECT_FALSE(command.feed_masks_panel);
  Bench never;
  EXPECT_EQ(never.supervisor.update_without_frame(0.0).feed_reason, Reason::input_stale);
}

// A feed or spindle change in mid-thread ruins it; panel 0 still stops.
TEST(Safety, ThreadingAndTappingHoldTheOverridesButNotAgainstTheOperator) {
  for (const auto motion : {signal::Motion::thread, signal::Motion::tap}) {
    Bench bench;
    bench.wish_feed(0.6);
    bench.wish_spindle(0.8);
    bench.cycles(500);
    bench.frame.motion = motion;
    bench.wish_feed(0.2);
    bench.wish_spindle(1.1);
    auto command = bench.cycles(500);
    EXPECT_EQ(command.feed_ratio, 0.6);
    EXPECT_EQ(command.spindle_ratio, 0.8);
    EXPECT_EQ(command.feed_reason, Reason::withdrawn_thread);
    bench.frame.feed.panel_ratio = 0.0;
    command = bench.cycle();
    EXPECT_EQ(command.feed_ratio, 0.0);
    EXPECT_FALSE(command.feed_masks_panel);
    bench.frame.feed.panel_ratio = 1.0;
    bench.frame.motion = signal::Motion::feed;
    EXPECT_EQ(bench.cycles(800).feed_ratio, 0.2);
  }
}

TEST(Safety, AllPassesOfAThreadAreCutAtOneSpeed) {
  Bench bench;
  bench.wish_spindle(0.8);
  bench.cycles(500);
  for (const double wish : {1.1, 0.7, 0.9}) {
    bench.frame.motion = signal::Motion::thread;
    EXPECT_EQ(bench.cycles(300).spindle_ratio, 0.8);
    bench.wish_spindle(wish);
    for (const auto way : {signal::Motion::rapid, signal::Motion::dwell, signal::Motion::rapid}) {
      bench.frame.motion = way;
      EXPECT_EQ(bench.cycles(300).spindle_ratio, 0.8);
    }
  }
  EXPECT_EQ(bench.cycles(11'000).spindle_ratio, 0.9) << "no way back takes as long";
  bench.frame.motion = signal::Motion::thread;
  bench.wish_spindle(0.8);
  bench.cycles(300);
  bench.frame.motion = signal::Motion::rapid;
  EXPECT_EQ(bench.cycles(300).spindle_ratio, 0.9);
  bench.frame.motion = signal::Motion::feed;
  EXPECT_EQ(bench.cycles(800).spindle_ratio, 0.8);
  bench.wish_spindle(0.9);
  EXPECT_EQ(bench.cycles(800).spindle_ratio, 0.9);
  bench.frame.motion = signal::Motion::tap;
  bench.wish_spindle(0.8);
  EXPECT_EQ(bench.cycles(300).spindle_ratio, 0.9);
  bench.frame.motion = signal::Motion::rapid;
  EXPECT_EQ(bench.cycles(800).spindle_ratio, 0.8) << "each hole is tapped by itself";
}

TEST(Safety, WhoeverLeavesActGetsTheMachineBackBetweenTwoPasses) {
  Bench bench;
  bench.wish_spindle(0.8);
  bench.cycles(500);
  bench.frame.motion = signal::Motion::thread;
  bench.supervisor.set_mode(kernel::machine::Mode::observe);
  EXPECT_EQ(bench.cycles(300).spindle_ratio, 0.8);
  bench.frame.motion = signal::Motion::rapid;
  bench.cycles(800);
  EXPECT_EQ(bench.supervisor.mode_in_force(), kernel::machine::Mode::observe);
}

// Frozen by bad input, by a dwell, by a stale frame; out at 0.05 mm/s, so 5 µm in the 100 cycles
// after the first good frame that shows a rapid.
TEST(Safety, AnOffsetFreezesOnBadInputAndRampsOutWhenNoToolIsInTheCut) {
  Bench bench;
  bench.wish_offset(0.02);
  EXPECT_EQ(bench.cycles(1000).offset_mm[2], 0.02);
  bench.offset[0].offset_mm[0] = kNan;
  EXPECT_EQ(bench.cycles(1000).offset_mm[2], 0.02);
  bench.frame.motion = signal::Motion::dwell;
  EXPECT_EQ(bench.cycles(1000).offset_mm[2], 0.02) << "a dwell at the bottom is in the cut";
  bench.frame.motion = signal::Motion::rapid;
  bench.frame.age_s = 1.0;
  EXPECT_EQ(bench.cycles(1000).offset_mm[2], 0.02) << "a stale frame does not say that it is out";
  bench.frame.age_s = 0.0;
  EXPECT_NEAR(bench.cycles(100).offset_mm[2], 0.015, 1e-9);
  EXPECT_EQ(bench.cycles(1000).offset_mm[2], 0.0);
}

TEST(Safety, OffsetsStayInsideTheirLimitAndOffTheRotaryAxes) {
  Bench bench;
  bench.wish_offset(5.0);
  bench.offset[0].offset_mm[3] = 0.1;
  const auto command = bench.cycles(10'000);
  EXPECT_EQ(command.offset_mm[2], 0.2);
  EXPECT_EQ(command.offset_mm[3], 0.0);
  EXPECT_EQ(command.offset_reason, Reason::clamped);
}

// Faults pile up from case to case; none of them may stop the heartbeat.
TEST(Safety, TheHeartbeatBeatsOnceInEveryCycleWhateverComes) {
  for (const Mode mode : {Mode::observe, Mode::advise, Mode::act}) {
    Bench bench(mode);
    std::uint64_t last = bench.cycle().heartbeat;
    for (const auto& spoil : kSpoils) {
      spoil.spoil(bench.frame);
      EXPECT_EQ(bench.cycle().heartbeat, last + 1);
      ++last;
    }
  }
}

// With infinite rates and limits a file could turn the envelope off.
TEST(Safety, ClampAndSlewCannotBeSwitchedOffByTheMachineFile) {
  const auto refused = [](auto&& spoil) {
    auto machine = mill(Mode::act);
    spoil(machine.envelope);
    return !Supervisor::make(machine, kAll);
  };
  EXPECT_TRUE(refused([](auto& e) { e.feed_rise_1_s = kInfinity; }));
  EXPECT_TRUE(refused([](auto& e) { e.feed_fall_1_s = 0.0; }));
  EXPECT_TRUE(refused([](auto& e) { e.max_feed_ratio = kInfinity; }));
  EXPECT_TRUE(refused([](auto& e) { e.spindle_slew_1_s = kNan; }));
  EXPECT_TRUE(refused([](auto& e) { e.max_offset_mm = kInfinity; }));
  EXPECT_TRUE(refused([](auto& e) { e.offset_slew_mm_s = kInfinity; }));
  EXPECT_TRUE(refused([](auto& e) { e.stale_after_s = kInfinity; }));
}

// Read between two writes, a binary word can show any code in between: half-way from 0111 to 1000
// it may read 1111. Gray codes or a latch, or no writing.
TEST(Safety, ABinaryWordOnAPortThatDoesNotLatchIsRefused) {
  auto machine = mill(Mode::act);
  machine.feed_override = kernel::override::test::percent_word();
  auto capability = kAll;
  capability.latched_word = false;
  EXPECT_FALSE(Supervisor::make(machine, capability));
  capability.feed_override = false;
  EXPECT_TRUE(Supervisor::make(machine, capability)) << "what is never written cannot be misread";
  EXPECT_TRUE(Supervisor::make(machine, kAll));
}

}  // namespace
}  // namespace steadyrest::supervisor
