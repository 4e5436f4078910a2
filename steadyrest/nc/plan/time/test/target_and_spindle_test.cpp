// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <cmath>

#include <gtest/gtest.h>
#include <rapidcheck.h>
#include <rapidcheck/gtest.h>

#include <steadyrest/nc/plan/time/look_ahead.hpp>
#include <steadyrest/nc/plan/time/spindle_clock.hpp>

namespace steadyrest::nc::plan {
namespace {

constexpr Overrides kTurned{
    .feed_ratio = 0.5, .rapid_ratio = 0.25, .spindle_actual_rev_s = -20.0, .spindle_ratio = 0.9};

// Each kind of segment has one override, or none; the segment's limit is above all of them.
TEST(Target, IsWhatTheSegmentsOwnOverrideMakesOfItsFeed) {
  SegmentPlan feed{.feed_mm_s = 40.0, .speed_limit_mm_s = 100.0};
  EXPECT_EQ(target_mm_s(feed, kTurned), 20.0);
  SegmentPlan rapid = feed;
  rapid.rapid = true;
  EXPECT_EQ(target_mm_s(rapid, kTurned), 10.0);
  SegmentPlan thread = feed;
  thread.locked = true;
  EXPECT_EQ(target_mm_s(thread, kTurned), 40.0);
  SegmentPlan locked_rapid = rapid;
  locked_rapid.locked = true;
  EXPECT_EQ(target_mm_s(locked_rapid, kTurned), 10.0) << "a thread locks only the feed override";
}

// 0.3 mm/rev at 20 rev/s in either direction; the actual speed already includes the override.
TEST(Target, OfAFeedPerRevolutionFollowsTheActualSpindle) {
  SegmentPlan turning{.feed_mm_s = 0.3, .speed_limit_mm_s = 100.0, .per_revolution = true};
  EXPECT_NEAR(target_mm_s(turning, kTurned), 3.0, 1e-12);
  turning.locked = true;
  EXPECT_NEAR(target_mm_s(turning, kTurned), 6.0, 1e-12);
  turning.speed_limit_mm_s = 5.0;
  EXPECT_EQ(target_mm_s(turning, kTurned), 5.0);
}

kernel::machine::Spindle spindle_of(double most_rev_s, double acceleration_rev_s2) {
  kernel::machine::Spindle spindle;
  spindle.max_rev_s = most_rev_s;
  spindle.acceleration_rev_s2 = acceleration_rev_s2;
  return spindle;
}

// Checked by stepping until the speed is within 5 % of the command, from any speed to any other,
// also through standstill.
RC_GTEST_PROP(SpindleClock, SaysHowLongItTakesToBeAtSpeed, ()) {
  const double rate = *rc::gen::inRange(1, 100);
  SpindleClock clock(spindle_of(100.0, rate));
  clock.command(*rc::gen::inRange(-100, 101));
  clock.advance(*rc::gen::inRange(0, 100) / 10.0);
  const double wanted = *rc::gen::inRange(-100, 101);
  clock.command(wanted);
  const double promised_s = clock.seconds_to_speed();
  RC_ASSERT(std::isfinite(promised_s));
  const double step_s = 0.02 / rate;
  double passed_s = 0.0;
  while (wanted != 0.0 && std::abs(clock.speed_rev_s() - wanted) > 0.05 * std::abs(wanted)) {
    clock.advance(step_s);
    passed_s += step_s;
  }
  RC_ASSERT(std::abs(promised_s - passed_s) <= 1.5 * step_s);
}

// The ramp is straight and ends at the command, not beyond it.
TEST(SpindleClock, RampsAtItsAccelerationAndStopsAtItsCommand) {
  SpindleClock clock(spindle_of(100.0, 10.0));
  clock.command(-25.0);
  EXPECT_TRUE(clock.ramps());
  clock.advance(1.5);
  EXPECT_NEAR(clock.speed_rev_s(), -15.0, 1e-12);
  clock.advance(2.0);
  EXPECT_EQ(clock.speed_rev_s(), -25.0);
  EXPECT_FALSE(clock.ramps());
  EXPECT_EQ(clock.seconds_to_speed(), 0.0);
}

// A stop needs no speed to wait for.
TEST(SpindleClock, StandingStillIsAtSpeedAtOnce) {
  SpindleClock clock(spindle_of(100.0, 10.0));
  clock.command(50.0);
  clock.advance(10.0);
  clock.command(0.0);
  EXPECT_EQ(clock.seconds_to_speed(), 0.0);
  EXPECT_TRUE(clock.ramps());
}

// A command beyond the machine's largest speed is reached near that speed, from either side.
TEST(SpindleClock, BeyondTheLargestSpeedThatOneCounts) {
  for (const double way : {1.0, -1.0}) {
    SpindleClock clock(spindle_of(100.0, 10.0));
    clock.command(way * 140.0);
    EXPECT_NEAR(clock.seconds_to_speed(), 95.0 / 10.0, 1e-12);
    clock.advance(9.6);
    EXPECT_EQ(clock.seconds_to_speed(), 0.0);
  }
}

// A spindle without acceleration never gets there.
TEST(SpindleClock, WithoutAccelerationTheWaitHasNoEnd) {
  SpindleClock clock(spindle_of(100.0, 0.0));
  clock.command(50.0);
  EXPECT_TRUE(std::isinf(clock.seconds_to_speed()));
}

}  // namespace
}  // namespace steadyrest::nc::plan
