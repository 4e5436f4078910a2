// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <vector>

#include <gtest/gtest.h>

#include <steadyrest/chatter/online/modulator.hpp>
#include <steadyrest/kernel/override/arbiter.hpp>
#include <steadyrest/kernel/override/test/published_tables.hpp>
#include <steadyrest/kernel/rt/testing/allocation_guard.hpp>

namespace steadyrest::chatter::online::test {
namespace {

namespace tables = kernel::override::test;
using kernel::outcome::Reason;
using kernel::signal::Motion;

constexpr double kCycle_s = 0.002;
constexpr double kSpeed_rev_s = 50.0;

Modulator::Config config() {
  Modulator::Config c;
  c.modulation = {.law = Law::sine, .amplitude_ratio = 0.1, .period_s = 1.0};
  c.spindle_table = tables::spindle_840d();
  c.spindle_table.layer_may_exceed_panel = true;
  c.feed_table = tables::feed_840d();
  c.fade_s = 0.2;
  return c;
}

/// A modulator, its frame and what came of its requests; the spindle and the feed follow at once.
class Bench {
 public:
  explicit Bench(const Modulator::Config& c = config()) : modulator(Modulator::make(c).value()) {
    frame.motion = Motion::feed;
    frame.speed_modulation = true;
    frame.programmed_feed_mm_s = 10.0;
    frame.path_speed_mm_s = 10.0;
    frame.spindle_programmed_rev_s = kSpeed_rev_s;
    frame.spindle_actual_rev_s = kSpeed_rev_s;
  }

  Modulator::Output cycle() {
    frame.time_s += kCycle_s;
    const auto out = modulator.update(frame, in_force);
    frame.spindle.effective_ratio = out.spindle.ratio;
    frame.spindle_actual_rev_s = out.spindle.ratio * frame.spindle_programmed_rev_s;
    frame.feed.effective_ratio = std::min(frame.feed.panel_ratio, out.feed.ratio);
    frame.path_speed_mm_s = frame.feed.effective_ratio * frame.programmed_feed_mm_s;
    in_force.feed = {frame.feed.effective_ratio, frame.feed.effective_ratio};
    in_force.spindle = {out.spindle.ratio, out.spindle.ratio};
    return out;
  }
  std::vector<Modulator::Output> run(double time_s) {
    std::vector<Modulator::Output> all;
    for (double t = 0.0; t < time_s; t += kCycle_s) {
      all.push_back(cycle());
    }
    return all;
  }

  Modulator modulator;
  kernel::signal::Frame frame;
  kernel::signal::InForce in_force{.written = true};
};

std::vector<double> ratios(const std::vector<Modulator::Output>& outputs) {
  std::vector<double> all;
  for (const auto& out : outputs) {
    all.push_back(out.spindle.ratio);
  }
  return all;
}

std::size_t changes(const std::vector<double>& values) {
  std::size_t count = 0;
  for (std::size_t i = 1; i < values.size(); ++i) {
    count += values[i] != values[i - 1] ? 1U : 0U;
  }
  return count;
}

// Five steps of 5 % from 0.90 to 1.10: up and down make eight changes in a period. The word is off
// by half a step plus what the hysteresis holds back.
TEST(Modulator, ASineGoesThroughTheStepsOfTheTableAndBack) {
  Bench bench;
  bench.run(1.0);
  const auto out = bench.run(1.0);
  const auto all = ratios(out);
  EXPECT_DOUBLE_EQ(*std::ranges::max_element(all), 1.10);
  EXPECT_DOUBLE_EQ(*std::ranges::min_element(all), 0.90);
  EXPECT_EQ(changes(all), 8U) << "four steps up, four down, no flutter";
  for (const auto& o : out) {
    EXPECT_NEAR(o.ratio, 1.0 + 0.1 * std::sin(2.0 * std::numbers::pi * o.phase), 1e-9);
    EXPECT_LE(std::abs(o.spindle.ratio - o.ratio), 0.025 + 0.5 * 0.1 * 0.05 + 1e-9);
    EXPECT_EQ(o.spindle.reason, Reason::chatter_modulating);
  }
}

TEST(Modulator, EachLawHasItsShareOfHighAndLow) {
  for (const Law law :
       {Law::square, Law::pulse, Law::triangle, Law::sine, Law::random, Law::stop}) {
    auto c = config();
    c.modulation.law = law;
    c.modulation.period_s = 4.0;
    Bench bench(c);
    bench.run(4.0);
    double mean = 0.0;
    const auto out = bench.run(4.0);
    for (const auto& o : out) {
      mean += o.ratio / static_cast<double>(out.size());
    }
    EXPECT_NEAR(mean, 1.0, 0.004) << "the mean speed stays";
    const auto all = ratios(out);
    EXPECT_GE(*std::ranges::max_element(all) - *std::ranges::min_element(all), 0.1 - 1e-9);
  }
}

TEST(Modulator, ConstantStandsOnTheStepOfTheMean) {
  auto c = config();
  c.modulation.law = Law::constant;
  c.modulation.mean_ratio = 0.9;
  Bench bench(c);
  bench.run(1.0);
  for (const auto& o : bench.run(1.0)) {
    EXPECT_DOUBLE_EQ(o.spindle.ratio, 0.9);
  }
}

TEST(Modulator, AnAmplitudeInRevolutionsIsThatOfTheSpeed) {
  auto c = config();
  c.modulation.amplitude_rev_s = 5.0;
  Bench bench(c);
  EXPECT_DOUBLE_EQ(bench.cycle().amplitude_ratio, 0.1);
  bench.frame.spindle_programmed_rev_s = 100.0;
  EXPECT_DOUBLE_EQ(bench.cycle().amplitude_ratio, 0.05);
}

// 102.5 % is the middle between two steps: without hysteresis the word would flutter in every
// cycle.
TEST(Modulator, NoiseAtTheBorderOfTwoStepsDoesNotMoveIt) {
  auto c = config();
  c.modulation.law = Law::constant;
  c.modulation.mean_ratio = 1.025;
  Bench bench(c);
  bench.run(1.0);
  std::vector<double> all;
  for (int i = 0; i < 400; ++i) {
    auto m = bench.modulator.state().modulation;
    m.mean_ratio = 1.025 + (i % 2 == 0 ? 0.002 : -0.002);
    ASSERT_TRUE(bench.modulator.change(m));
    all.push_back(bench.cycle().spindle.ratio);
  }
  EXPECT_EQ(changes(all), 0U);
}

TEST(Modulator, AChangeWhileItRunsMakesNeitherPhaseNorSpeedJump) {
  auto c = config();
  c.acceleration_rev_s2 = 2.0 * kSpeed_rev_s;
  Bench bench(c);
  bench.run(1.3);
  double phase = bench.modulator.state().phase;
  double ratio = bench.modulator.state().ratio;
  const std::vector<Modulation> settings{
      {.law = Law::square, .amplitude_ratio = 0.15, .period_s = 0.5},
      {.law = Law::triangle, .amplitude_ratio = 0.02, .period_s = 7.0, .mean_ratio = 0.8},
      {.law = Law::random, .amplitude_ratio = 0.1, .period_s = 1.0, .seed = 9},
      {.law = Law::stop, .amplitude_rev_s = 6.0, .period_s = 3.0}};
  for (const auto& m : settings) {
    ASSERT_TRUE(bench.modulator.change(m));
    for (int i = 0; i < 300; ++i) {
      const auto out = bench.cycle();
      double turned = out.phase - phase;
      turned -= std::floor(turned);
      ASSERT_NEAR(turned, kCycle_s / m.period_s, 1e-9);
      ASSERT_LE(std::abs(out.ratio - ratio), 2.0 * kCycle_s + 1e-12);
      phase = out.phase;
      ratio = out.ratio;
    }
  }
}

TEST(Modulator, AChangeThatIsNotFitIsNotTaken) {
  Bench bench;
  constexpr double kNan = std::numeric_limits<double>::quiet_NaN();
  EXPECT_FALSE(bench.modulator.change({.amplitude_ratio = kNan}));
  EXPECT_FALSE(bench.modulator.change({.amplitude_ratio = 0.95}));
  EXPECT_FALSE(bench.modulator.change({.period_s = 0.0}));
  EXPECT_FALSE(bench.modulator.change({.mean_ratio = kNan}));
  EXPECT_FALSE(bench.modulator.change({.law = static_cast<Law>(7)}));
  EXPECT_EQ(bench.modulator.state().modulation.law, Law::sine);
}

// Cut off at 100 % the sine would dwell there for half its period, and chatter grows in a dwell.
TEST(Modulator, BelowTheOperatorsSwitchTheWholeSwingMovesDown) {
  auto c = config();
  c.spindle_table.layer_may_exceed_panel = false;
  Bench bench(c);
  bench.run(1.0);
  const auto all = ratios(bench.run(1.0));
  EXPECT_DOUBLE_EQ(*std::ranges::max_element(all), 1.0);
  EXPECT_DOUBLE_EQ(*std::ranges::min_element(all), 0.80);
  EXPECT_EQ(bench.cycle().spindle.reason, Reason::chatter_swing_narrowed);
}

TEST(Modulator, FadesInAndOutAtTheRateOfTheFade) {
  Bench bench;
  double fade = 0.0;
  for (const auto& o : bench.run(0.19)) {
    EXPECT_NEAR(o.fade - fade, kCycle_s / 0.2, 0.011);
    EXPECT_EQ(o.spindle.reason == Reason::chatter_fading || o.fade == 0.0, true);
    fade = o.fade;
  }
  bench.run(0.5);
  bench.frame.speed_modulation = false;
  const auto out = bench.run(0.25);
  EXPECT_GT(out.front().fade, 0.9);
  EXPECT_EQ(out[50].spindle.reason, Reason::chatter_fading);
  EXPECT_EQ(out.back().spindle.reason, Reason::none);
  EXPECT_EQ(out.back().spindle.ratio, 1.0);
}

TEST(Modulator, WithdrawsWhereNothingIsCutAndWhereTheOverrideMustNotMove) {
  constexpr double kNan = std::numeric_limits<double>::quiet_NaN();
  const auto after = [](auto&& spoil) {
    Bench bench;
    bench.run(1.0);
    spoil(bench.frame);
    return bench.cycle();
  };
  const auto expect = [](const Modulator::Output& out, Reason reason) {
    EXPECT_EQ(out.spindle.reason, reason) << name(out.spindle.reason);
    EXPECT_EQ(out.spindle.ratio, 1.0);
    EXPECT_EQ(out.feed.ratio, 1.0);
    EXPECT_FALSE(kernel::override::is_wish(out.feed.reason));
    EXPECT_FALSE(out.active);
  };
  expect(after([](auto& f) { f.motion = Motion::thread; }), Reason::withdrawn_thread);
  expect(after([](auto& f) { f.motion = Motion::tap; }), Reason::withdrawn_thread);
  expect(after([&](auto& f) { f.spindle_actual_rev_s = kNan; }), Reason::input_not_finite);
  expect(after([&](auto& f) { f.feed.panel_ratio = kNan; }), Reason::input_not_finite);
  expect(after([](auto& f) { f.age_s = 0.2; }), Reason::input_stale);
  expect(after([](auto& f) { f.time_s = 0.1; }), Reason::input_out_of_range);
  expect(after([](auto& f) { f.spindle_programmed_rev_s = 0.0; }), Reason::none);
  Bench rapid;
  rapid.run(1.0);
  rapid.frame.motion = Motion::rapid;
  expect(rapid.run(0.3).back(), Reason::not_cutting);
}

// At 90 % speed a feed of 95 % would be 1.056 of the programmed chip, so the feed goes to 90 %.
TEST(Modulator, TheFeedFollowsTheSpindleDown) {
  auto c = config();
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
  auto c = config();
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

// The spindle is asked for 100 %, but something holds its override at 90 %.
TEST(Modulator, TheFeedKeepsToTheSpeedThatTheControlWasToldNotToTheOneAsked) {
  auto c = config();
  c.modulation.law = Law::constant;
  c.max_feed_per_tooth_ratio = 1.0;
  Bench bench(c);
  EXPECT_EQ(bench.run(0.5).back().feed.ratio, 1.0);
  bench.in_force.spindle = {.ratio = 0.9, .word_ratio = 0.9};
  bench.frame.time_s += kCycle_s;
  EXPECT_EQ(bench.modulator.update(bench.frame, bench.in_force).spindle.ratio, 1.0);
  EXPECT_EQ(bench.modulator.update(bench.frame, bench.in_force).feed.ratio, 0.9);
}

// The feed is asked down to 90 %, but its word is still at 100 %.
TEST(Modulator, TheSpindleWaitsForTheFeedThatTheControlWasToldNotForTheOneAsked) {
  auto c = config();
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

TEST(Modulator, BeginsAtWhatIsInForce) {
  auto c = config();
  c.acceleration_rev_s2 = 0.5 * kSpeed_rev_s;
  Bench bench(c);
  bench.in_force.spindle = {.ratio = 0.82, .word_ratio = 0.80};
  EXPECT_NEAR(bench.cycle().ratio, 0.82, 0.5 * kCycle_s + 1e-12);
}

TEST(Modulator, FeedPerRevolutionIsLeftAlone) {
  auto c = config();
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
  auto c = config();
  c.modulation.amplitude_ratio = 0.2;
  c.min_feed_per_tooth_ratio = 0.95;
  Bench bench(c);
  bench.run(1.0);
  for (const auto& o : bench.run(1.0)) {
    EXPECT_LE(o.spindle.ratio, 1.05 + 1e-9);
  }
}

TEST(Modulator, ARestoredStateGoesOnWhereItWas) {
  Bench first;
  first.run(0.7);
  Bench second;
  second.frame = first.frame;
  second.in_force = first.in_force;
  second.modulator.restore(first.modulator.state());
  for (int i = 0; i < 1000; ++i) {
    const auto a = first.cycle();
    const auto b = second.cycle();
    ASSERT_EQ(a.spindle.ratio, b.spindle.ratio);
    ASSERT_EQ(a.phase, b.phase);
  }
  auto spoilt = first.modulator.state();
  spoilt.phase = std::numeric_limits<double>::quiet_NaN();
  second.modulator.restore(spoilt);
  EXPECT_EQ(second.modulator.state().phase, 0.0);
}

TEST(Modulator, RefusesWhatItCannotWorkWith) {
  const auto refused = [](auto&& spoil) {
    auto c = config();
    spoil(c);
    return !Modulator::make(c).has_value();
  };
  EXPECT_FALSE(refused([](auto&) {}));
  EXPECT_TRUE(refused([](auto& c) { c.spindle_table.ratio = {1.0}; }));
  EXPECT_TRUE(refused([](auto& c) { c.spindle_table = {}; }));
  EXPECT_TRUE(refused([](auto& c) { c.min_ratio = 0.98, c.max_ratio = 1.02; }));
  EXPECT_TRUE(refused([](auto& c) { c.min_ratio = 0.0; }));
  EXPECT_TRUE(refused([](auto& c) { c.acceleration_rev_s2 = 0.0; }));
  EXPECT_TRUE(refused([](auto& c) { c.modulation.period_s = 0.0; }));
  EXPECT_TRUE(refused([](auto& c) { c.max_feed_per_tooth_ratio = 0.9; }));
  EXPECT_TRUE(refused([](auto& c) { c.fade_s = std::numeric_limits<double>::quiet_NaN(); }));
}

TEST(Modulator, ACycleAllocatesNothing) {
  Bench bench;
  bench.run(0.1);
  const kernel::rt::testing::AllocationGuard guard;
  for (int i = 0; i < 500; ++i) {
    bench.frame.motion = i % 100 < 80 ? Motion::feed : Motion::tap;
    ASSERT_TRUE(bench.modulator.change({.law = static_cast<Law>(i % 7)}));
    bench.cycle();
  }
}

}  // namespace
}  // namespace steadyrest::chatter::online::test
