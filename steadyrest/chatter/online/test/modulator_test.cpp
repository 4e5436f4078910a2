// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <vector>

#include <gtest/gtest.h>

#include <steadyrest/chatter/online/modulator.hpp>
#include <steadyrest/chatter/online/test/modulator_bench.hpp>
#include <steadyrest/kernel/override/arbiter.hpp>
#include <steadyrest/kernel/rt/testing/allocation_guard.hpp>

namespace steadyrest::chatter::online::test {
namespace {

using kernel::outcome::Reason;
using kernel::signal::Motion;

std::size_t changes(const std::vector<double>& values) {
  std::size_t count = 0;
  for (std::size_t i = 1; i < values.size(); ++i) {
    count += values[i] != values[i - 1] ? 1U : 0U;
  }
  return count;
}

// Five steps of 5 % from 0.90 to 1.10: up and down make eight changes in a period. The word is off
// by half a step plus the hysteresis.
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
    auto c = sine_config();
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
  auto c = sine_config();
  c.modulation.law = Law::constant;
  c.modulation.mean_ratio = 0.9;
  Bench bench(c);
  bench.run(1.0);
  for (const auto& o : bench.run(1.0)) {
    EXPECT_DOUBLE_EQ(o.spindle.ratio, 0.9);
  }
}

TEST(Modulator, AnAmplitudeInRevolutionsIsThatOfTheSpeed) {
  auto c = sine_config();
  c.modulation.amplitude_rev_s = 5.0;
  Bench bench(c);
  EXPECT_DOUBLE_EQ(bench.cycle().amplitude_ratio, 0.1);
  bench.frame.spindle_programmed_rev_s = 100.0;
  EXPECT_DOUBLE_EQ(bench.cycle().amplitude_ratio, 0.05);
}

// 102.5 % is midway between two steps: without hysteresis the word would flutter in every cycle.
TEST(Modulator, NoiseAtTheBorderOfTwoStepsDoesNotMoveIt) {
  auto c = sine_config();
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
  auto c = sine_config();
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

TEST(Modulator, BeginsAtWhatIsInForce) {
  auto c = sine_config();
  c.acceleration_rev_s2 = 0.5 * kSpeed_rev_s;
  Bench bench(c);
  bench.in_force.spindle = {.ratio = 0.82, .word_ratio = 0.80};
  EXPECT_NEAR(bench.cycle().ratio, 0.82, 0.5 * kCycle_s + 1e-12);
}

TEST(Modulator, AfterAThreadItGoesOnFromWhatWasHeld) {
  auto c = sine_config();
  c.modulation = {.law = Law::constant, .mean_ratio = 0.6};
  Bench bench(c);
  ASSERT_EQ(bench.run(1.0).back().spindle.ratio, 0.6);
  const kernel::signal::InForce held = bench.in_force;
  kernel::signal::Frame frame = bench.frame;
  frame.motion = Motion::thread;
  for (int i = 0; i < 500; ++i) {
    frame.time_s = bench.frame.time_s;
    bench.frame = frame;
    EXPECT_EQ(bench.cycle().spindle.reason, Reason::withdrawn_thread);
    bench.in_force = held;
  }
  frame.time_s = bench.frame.time_s;
  bench.frame = frame;
  bench.frame.motion = Motion::feed;
  for (const Modulator::Output& out : bench.run(1.0)) {
    ASSERT_EQ(out.spindle.ratio, 0.6);
  }
}

TEST(Modulator, WhatHasNotQuiteComeInLeavesWithoutAJump) {
  auto c = sine_config();
  c.modulation = {.law = Law::constant, .mean_ratio = 0.6};
  Bench bench(c);
  bench.in_force.spindle = {.ratio = 0.7, .word_ratio = 0.7};
  bench.in_force.feed = {.ratio = 0.6, .word_ratio = 0.6};
  bench.frame.feed.panel_ratio = 0.6;
  const double before = bench.run(0.04).back().goal_ratio;
  EXPECT_NEAR(before, 0.68, 0.011);
  bench.frame.speed_modulation = false;
  double goal = before;
  for (const Modulator::Output& out : bench.run(0.5)) {
    EXPECT_LE(std::abs(out.goal_ratio - goal), 0.4 * kCycle_s / 0.2 + 1e-9);
    goal = out.spindle.reason == Reason::none ? goal : out.goal_ratio;
  }
  EXPECT_GT(goal, 0.98);
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
    auto c = sine_config();
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
