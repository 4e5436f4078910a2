// SPDX-License-Identifier: Apache-2.0
// Where the clock's rules end, from both sides.
#include <cmath>

#include <gtest/gtest.h>

#include <steadyrest/kernel/units/constants.hpp>
#include <steadyrest/supervisor/frame_clock.hpp>

namespace steadyrest::supervisor {
namespace {

using kernel::outcome::Reason;
using kernel::units::kInfinity;
using kernel::units::kNan;

constexpr double kPeriod_s = 0.004;

FrameClock clock_at(double stamp_s) {
  FrameClock clock = FrameClock::make({.usual_s = kPeriod_s}).value();
  clock.update(stamp_s);
  return clock;
}

// 10¹⁰ s are 317 years; beyond that a double has no microseconds.
TEST(FrameClockLimits, TimeBeginsUpToTenBillionSeconds) {
  for (const double sign : {1.0, -1.0}) {
    FrameClock clock = FrameClock::make({.usual_s = kPeriod_s}).value();
    EXPECT_EQ(clock.update(sign * std::nextafter(1e10, kInfinity)).fault,
              Reason::input_out_of_range);
    EXPECT_FALSE(clock.state().started);
    EXPECT_TRUE(clock.update(sign * 1e10).good);
  }
}

// A first stamp is good and counts as set; a repeated one is good and gives no time.
TEST(FrameClockLimits, TheFirstStampIsGoodAndGivesNoCredit) {
  FrameClock clock = FrameClock::make({.usual_s = kPeriod_s}).value();
  const auto first = clock.update(123.0);
  EXPECT_TRUE(first.good);
  EXPECT_TRUE(first.set);
  EXPECT_FALSE(first.jumped);
  EXPECT_EQ(first.step_s, 0.0);
  EXPECT_EQ(first.time_s, 123.0);
  EXPECT_EQ(first.stamped_s, 123.0);
  for (int i = 0; i < 100; ++i) {
    EXPECT_TRUE(clock.update(123.0).good);
  }
  EXPECT_EQ(clock.state().usual_s, kPeriod_s) << "a repeated stamp says nothing of the step";
}

// A frame every ten seconds is a slow source; beyond that it is no source.
TEST(FrameClockLimits, ASlowSourceMayTakeTenSecondsAStep) {
  const auto credited = [](double step_s) {
    FrameClock clock = clock_at(0.0);
    double credit_s = 0.0;
    for (int i = 1; i <= 40; ++i) {
      credit_s += clock.update(step_s * i).step_s;
    }
    return credit_s;
  };
  EXPECT_NEAR(credited(10.0), 23 * 10.0, 1e-9) << "from the 18th frame on";
  EXPECT_EQ(credited(10.01), 0.0);
}

// Alternating steps of 60 and 90 ms: T becomes their mean, and both then count.
TEST(FrameClockLimits, TheStepOfASlowSourceIsTheMeanOfItsSteps) {
  FrameClock clock = clock_at(0.0);
  double stamp_s = 0.0;
  for (int i = 0; i < 17; ++i) {
    stamp_s += i % 2 == 0 ? 0.060 : 0.090;
    clock.update(stamp_s);
  }
  EXPECT_NEAR(clock.state().usual_s, 0.075, 0.001);
  EXPECT_TRUE(clock.update(stamp_s + 0.090).good);
}

// One stamp that falls back ends the run: twice fifteen steps are not sixteen.
TEST(FrameClockLimits, ASlowSourceMustKeepRising) {
  FrameClock clock = clock_at(0.0);
  double stamp_s = 1.0;
  for (int run = 0; run < 3; ++run) {
    for (int i = 0; i < 16; ++i) {
      stamp_s += 0.075;
      EXPECT_FALSE(clock.update(stamp_s).good) << run << ", " << i;
    }
    stamp_s -= 0.5;
  }
}

// In doubt the frame is judged by its place: ahead it may be right, behind its age is unknown.
TEST(FrameClockLimits, AStampInDoubtSaysWhereItLies) {
  FrameClock clock = clock_at(100.0);
  const auto ahead = clock.update(107.0);
  EXPECT_EQ(ahead.fault, Reason::none);
  EXPECT_EQ(ahead.stamped_s, 107.0);
  EXPECT_EQ(ahead.time_s, 100.0);
  const auto behind = clock.update(93.0);
  EXPECT_EQ(behind.fault, Reason::input_out_of_range);
  EXPECT_EQ(behind.stamped_s, 93.0);
  const auto none = clock.update(kNan);
  EXPECT_EQ(none.fault, Reason::input_not_finite);
  EXPECT_EQ(none.stamped_s, 100.0);
}

// Set back by 7 s and running: good time continues from where it was, and so do its stamps.
TEST(FrameClockLimits, AfterASetBackStampsAreShifted) {
  FrameClock clock = clock_at(100.0);
  clock.update(93.0);
  const auto set = clock.update(93.0 + kPeriod_s);
  EXPECT_TRUE(set.set);
  EXPECT_FALSE(set.jumped);
  const auto next = clock.update(93.0 + 2 * kPeriod_s);
  EXPECT_NEAR(next.time_s, 100.0 + 2 * kPeriod_s, 1e-9);
  EXPECT_EQ(next.stamped_s, next.time_s);
  EXPECT_NEAR(next.step_s, kPeriod_s, 1e-9);
  const auto gap = clock.update(200.0);
  EXPECT_NEAR(gap.stamped_s, 207.0, 1e-9);
}

// Any field that is not finite spoils a state; with T at 0 no stamp could be good.
TEST(FrameClockLimits, EachFieldOfAStateMustBeANumber) {
  const FrameClock::State fit = clock_at(100.0).state();
  const auto taken = [](const FrameClock::State& state) {
    FrameClock clock = clock_at(5.0);
    clock.restore(state);
    return clock.state().started && clock.time_s() == 100.0;
  };
  ASSERT_TRUE(taken(fit));
  for (double FrameClock::State::* field :
       {&FrameClock::State::stamp_s, &FrameClock::State::shift_s, &FrameClock::State::usual_s,
        &FrameClock::State::candidate_s, &FrameClock::State::run_from_s}) {
    for (const double value : {kNan, kInfinity}) {
      FrameClock::State state = fit;
      state.*field = value;
      EXPECT_FALSE(taken(state));
    }
  }
  FrameClock::State state = fit;
  state.usual_s = 0.0;
  EXPECT_FALSE(taken(state));
}

}  // namespace
}  // namespace steadyrest::supervisor
