// SPDX-License-Identifier: Apache-2.0

#include <gtest/gtest.h>
#include <rapidcheck.h>
#include <rapidcheck/gtest.h>

#include <steadyrest/kernel/units/constants.hpp>
#include <steadyrest/supervisor/frame_clock.hpp>

namespace steadyrest::supervisor {
namespace {

using kernel::outcome::Reason;
using kernel::units::kInfinity;
using kernel::units::kNan;

constexpr double kUsual_s = 0.004;

FrameClock fresh() {
  return FrameClock::make({.usual_s = kUsual_s}).value();
}

FrameClock running() {
  FrameClock clock = fresh();
  for (int i = 1; i <= 100; ++i) {
    clock.update(kUsual_s * i);
  }
  return clock;
}

TEST(FrameClock, WhereAllStampsAreGoodItIsTheStamp) {
  FrameClock clock = fresh();
  for (int i = 1; i < 100'000; ++i) {
    const double stamp_s = kUsual_s * i;
    const auto tick = clock.update(stamp_s);
    ASSERT_TRUE(tick.good);
    ASSERT_EQ(tick.time_s, stamp_s);
    ASSERT_NEAR(tick.step_s, i == 1 ? 0.0 : kUsual_s, 1e-9);
  }
}

// 0.4 s is the last good stamp. Wrong ones are behind, far behind, just too far ahead, beyond a
// double's resolution, or not finite; the next cycle must have credit for one step, not two.
TEST(FrameClock, OneWrongStampGivesNoCreditAndMovesNothing) {
  for (const double wrong_s :
       {-1.0, -1e9, 0.3, 0.4 + 0.15, 5.0, 1e300, kNan, kInfinity, -kInfinity}) {
    FrameClock clock = running();
    const auto doubted = clock.update(wrong_s);
    EXPECT_FALSE(doubted.good) << wrong_s;
    EXPECT_EQ(doubted.step_s, 0.0) << wrong_s;
    EXPECT_EQ(doubted.time_s, 0.4) << wrong_s;
    const auto again = clock.update(0.4 + 2 * kUsual_s);
    EXPECT_TRUE(again.good) << wrong_s;
    EXPECT_NEAR(again.step_s, kUsual_s, 1e-12) << wrong_s;
    EXPECT_EQ(again.time_s, 0.4 + 2 * kUsual_s) << wrong_s;
  }
}

TEST(FrameClock, AStampMayBeLateByOneAndAHalfSteps) {
  FrameClock late = running();
  EXPECT_TRUE(late.update(0.4 + 2.4 * kUsual_s).good);
  FrameClock too_late = running();
  EXPECT_FALSE(too_late.update(0.4 + 2.6 * kUsual_s).good);
}

TEST(FrameClock, TheUsualStepFollowsByASixteenth) {
  FrameClock clock = running();
  clock.update(0.4 + 1.08 * kUsual_s);
  EXPECT_NEAR(clock.state().usual_s, kUsual_s * (1.0 + 0.08 / 16.0), 1e-9);
}

// A frozen sender: a thousand calls with the same stamp give no time.
TEST(FrameClock, TimeThatStandsGivesNoCredit) {
  FrameClock clock = running();
  for (int i = 0; i < 1000; ++i) {
    EXPECT_EQ(clock.update(0.4).step_s, 0.0);
  }
  EXPECT_NEAR(clock.update(0.4 + kUsual_s).step_s, kUsual_s, 1e-12);
}

TEST(FrameClock, AClockThatWasSetBackGoesOnFromItsSecondStamp) {
  FrameClock clock = running();
  EXPECT_EQ(clock.update(0.1).fault, Reason::input_out_of_range);
  const auto tick = clock.update(0.1 + kUsual_s);
  EXPECT_TRUE(tick.good);
  EXPECT_TRUE(tick.set);
  EXPECT_EQ(tick.fault, Reason::none);
  EXPECT_NEAR(tick.step_s, kUsual_s, 1e-12);
  EXPECT_NEAR(tick.time_s, 0.4 + kUsual_s, 1e-12) << "good time never runs backwards";
}

TEST(FrameClock, AGapPassesButGivesNoCredit) {
  FrameClock clock = running();
  const auto first = clock.update(60.0);
  EXPECT_FALSE(first.good);
  EXPECT_EQ(first.fault, Reason::none) << "what the frame shows may be acted on";
  const auto tick = clock.update(60.0 + kUsual_s);
  EXPECT_TRUE(tick.good);
  EXPECT_NEAR(tick.step_s, kUsual_s, 1e-12);
  EXPECT_EQ(tick.time_s, 60.0 + kUsual_s);
}

// Cycle 4 ms, stamps 75 ms apart. Frame 0 begins, 1 … 17 are in doubt (sixteen steps in a row), the
// steps of 18 … 99 count: 82.
TEST(FrameClock, ASlowSourceCountsFromItsSeventeenthFrame) {
  FrameClock clock = fresh();
  double counted_s = 0.0;
  for (int i = 0; i < 100; ++i) {
    counted_s += clock.update(0.075 * i).step_s;
  }
  EXPECT_NEAR(counted_s, 0.075 * 82, 1e-9);
}

// Every tenth frame is lost: the call after it covers two steps but counts as one call, so it gets
// 1.1 steps at most. 8 + 1.1 of 10 steps remain, 91 %; never more than have passed.
TEST(FrameClock, LostFramesOfARegularSourceCostTheirTime) {
  FrameClock clock = fresh();
  double counted_s = 0.0;
  for (int i = 0; i < 10'000; ++i) {
    if (i % 10 != 3) {
      counted_s += clock.update(kUsual_s * i + (i % 3) * 0.0002).step_s;
    }
  }
  EXPECT_GT(counted_s, 0.89 * 10'000 * kUsual_s);
  EXPECT_LE(counted_s, 0.93 * 10'000 * kUsual_s);
}

// At 1e300 neighbouring doubles lie 1e284 s apart: no cycle could ever be told from it.
TEST(FrameClock, AStampWithoutResolutionIsNoBeginning) {
  FrameClock clock = fresh();
  EXPECT_EQ(clock.update(1e300).fault, Reason::input_out_of_range);
  EXPECT_TRUE(clock.update(5.0).set);
  EXPECT_NEAR(clock.update(5.0 + kUsual_s).step_s, kUsual_s, 1e-12);
}

TEST(FrameClock, ARestoredStateGoesOnAsItWouldHave) {
  FrameClock clock = running();
  clock.update(9.0);  // in doubt
  FrameClock restored = fresh();
  restored.restore(clock.state());
  for (int i = 102; i <= 400; ++i) {
    const double stamp_s = i % 7 == 0 ? 9.0 + kUsual_s * i : kUsual_s * i;
    const FrameClock::Tick a = clock.update(stamp_s);
    const FrameClock::Tick b = restored.update(stamp_s);
    ASSERT_EQ(a.time_s, b.time_s);
    ASSERT_EQ(a.step_s, b.step_s);
    ASSERT_EQ(a.good, b.good);
    ASSERT_EQ(a.fault, b.fault);
  }
}

TEST(FrameClock, RefusesAPeriodThatIsNone) {
  EXPECT_FALSE(FrameClock::make({.usual_s = 0.0}));
  EXPECT_FALSE(FrameClock::make({.usual_s = kNan}));
}

TEST(FrameClock, AStateThatIsNotFiniteIsNotRestored) {
  FrameClock clock = running();
  auto state = clock.state();
  state.stamp_s = kNan;
  clock.restore(state);
  EXPECT_TRUE(clock.update(7.0).set);
  EXPECT_TRUE(clock.update(7.0 + kUsual_s).good);
}

// The law that all slews depend on. Real time is known here, the clock sees only stamps.
RC_GTEST_PROP(FrameClock, CreditNeverPassesTheRealTimeWhateverTheStamps, ()) {
  // The source is called every cycle; some stamps are wrong: anywhere, not finite, or repeated.
  FrameClock clock = running();
  double real_s = 0.4;
  double last_s = real_s;
  double credit_s = 0.0;
  const int cycles = *rc::gen::inRange(1, 400);
  const int wrong_of_20 = *rc::gen::inRange(0, 20);
  double offset_s = 0.0;
  for (int i = 0; i < cycles; ++i) {
    real_s += kUsual_s;
    if (*rc::gen::inRange(0, 60) == 0) {
      offset_s = *rc::gen::inRange(-1000, 1000) * 0.1;  // set, for good
    }
    double stamp_s = real_s + offset_s;
    if (*rc::gen::inRange(0, 20) < wrong_of_20) {
      stamp_s = *rc::gen::element(kNan, kInfinity, -kInfinity, 0.0, -1e300, 1e300, last_s,
                                  stamp_s - 1.0, stamp_s - 0.05, stamp_s + 0.15, stamp_s + 30.0);
    }
    last_s = stamp_s;
    const double before_s = clock.time_s();
    const auto tick = clock.update(stamp_s);
    credit_s += tick.step_s;
    RC_ASSERT(tick.step_s >= 0.0);
    RC_ASSERT(tick.step_s <= 1.3 * kUsual_s);
    RC_ASSERT(tick.time_s >= before_s);
    RC_ASSERT(credit_s <= real_s - 0.4 + 1e-9);
  }
}

}  // namespace
}  // namespace steadyrest::supervisor
