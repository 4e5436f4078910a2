// SPDX-License-Identifier: Apache-2.0
#include <cmath>
#include <limits>

#include <gtest/gtest.h>

#include <steadyrest/chatter/online/speed_table.hpp>

namespace steadyrest::chatter::online {
namespace {

using kernel::outcome::Reason;

std::vector<double> panel() {
  std::vector<double> out;
  for (int percent = 50; percent <= 120; percent += 5) {
    out.push_back(percent / 100.0);
  }
  return out;
}

/// The limiting depths of the slot in the reference (922 Hz, two teeth).
SpeedTable::Config slot() {
  SpeedTable::Config config;
  config.speed_rev_s = {3000 / 60.0, 4000 / 60.0, 4500 / 60.0,
                        5000 / 60.0, 5500 / 60.0, 6000 / 60.0};
  config.limit_depth_mm = {0.6802, 0.7367, 1.2254, 0.4086, 2.7653, 0.3532};
  config.step_ratio = panel();
  return config;
}

// 5500 rpm is the pocket of the slot, 110 %.
TEST(SpeedTable, TakesTheDeepestStepWhenTheDepthIsNotKnown) {
  const auto table = SpeedTable::make(slot());
  ASSERT_TRUE(table);
  const auto advice = table->ask({.programmed_rev_s = 5000 / 60.0});
  EXPECT_EQ(advice.reason, Reason::chatter_better_speed);
  EXPECT_EQ(advice.request.reason, Reason::chatter_better_speed);
  EXPECT_NEAR(advice.request.ratio, 1.10, 1e-12);
  EXPECT_NEAR(advice.limit_depth_mm, 2.7653, 1e-9);
}

// 95 % is 4750 rpm: half way between 1.2254 and 0.4086 mm is 0.817, above 1.1·0.6.
TEST(SpeedTable, TakesTheNearestStepThatCarriesTheDepth) {
  const auto table = SpeedTable::make(slot());
  ASSERT_TRUE(table);
  const auto advice = table->ask({.programmed_rev_s = 5000 / 60.0, .depth_mm = 0.6});
  EXPECT_NEAR(advice.request.ratio, 0.95, 1e-12);
  EXPECT_GE(advice.limit_depth_mm, 1.1 * 0.6);
}

// A millionth is what the rounding of a percentage makes. Beyond it the step is another, and 110 %
// is the deepest.
TEST(SpeedTable, AStepWithinAMillionthOfTheRatioInForceIsThePresentOne) {
  const auto table = SpeedTable::make(slot());
  ASSERT_TRUE(table);
  const auto reason_at = [&](double ratio) {
    return table->ask({.programmed_rev_s = 5000 / 60.0, .ratio = ratio}).reason;
  };
  EXPECT_EQ(reason_at(1.1 + 0.7e-6), Reason::chatter_no_better_speed);
  EXPECT_EQ(reason_at(1.1 + 1.4e-6), Reason::chatter_better_speed);
}

// All speeds allow 1 mm, none 2, so a change would be pointless.
TEST(SpeedTable, IsNeutralWhereNothingIsBetter) {
  SpeedTable::Config config = slot();
  config.min_ratio = 0.8;
  config.max_ratio = 1.0;
  config.speed_rev_s = {50.0, 100.0};
  config.limit_depth_mm = {1.0, 1.0};
  const auto table = SpeedTable::make(config);
  ASSERT_TRUE(table);
  const auto advice = table->ask({.programmed_rev_s = 5000 / 60.0, .depth_mm = 2.0});
  EXPECT_EQ(advice.reason, Reason::chatter_no_better_speed);
  EXPECT_EQ(advice.request.reason, Reason::none);
  EXPECT_EQ(advice.request.ratio, 1.0);
}

TEST(SpeedTable, WithoutATableWholeWavesLieBetweenTwoTeeth) {
  SpeedTable::Config config;
  config.step_ratio = panel();
  const auto table = SpeedTable::make(config);
  ASSERT_TRUE(table);
  // 60·922/(2·5) = 5532 rpm.
  const auto advice = table->ask({.programmed_rev_s = 5000 / 60.0, .frequency_hz = 922.0});
  EXPECT_EQ(advice.reason, Reason::chatter_rule_speed);
  EXPECT_NEAR(advice.request.ratio, 1.10, 1e-12);
  EXPECT_EQ(advice.waves, 5U);
}

TEST(SpeedTable, TheRuleDoesNotLeaveASpeedThatFitsItBetter) {
  SpeedTable::Config config;
  config.step_ratio = panel();
  const auto table = SpeedTable::make(config);
  ASSERT_TRUE(table);
  // 5 waves and a hundredth here; 55 % would have 9.1.
  const auto advice =
      table->ask({.programmed_rev_s = 922.0 / 2.0 / 5.01, .ratio = 1.0, .frequency_hz = 922.0});
  EXPECT_EQ(advice.reason, Reason::chatter_no_better_speed);
  EXPECT_EQ(advice.request.ratio, 1.0);
}

/// A single wave between two teeth at `whole` of the programmed speed, asked at 70 %.
SpeedTable::Advice advice_for_one_wave(double whole) {
  SpeedTable::Config config;
  config.step_ratio = panel();
  // Two waves, at half the speed, are excluded.
  config.min_ratio = 0.8 * whole;
  return SpeedTable::make(config)->ask(
      {.programmed_rev_s = 100.0, .ratio = 0.7, .frequency_hz = 2.0 * 100.0 * whole});
}

// From 100 % on a switch in steps of 5 % has a step within half a step of any speed, so the rule
// finds one, the nearest; at half the speed the same steps lie too far apart for it.
TEST(SpeedTable, TheRuleReachesHalfAStepOfTheSwitch) {
  for (double whole = 1.0; whole < 1.15; whole += 0.0037) {
    const auto advice = advice_for_one_wave(whole);
    ASSERT_EQ(advice.reason, Reason::chatter_rule_speed) << whole;
    EXPECT_LT(std::abs(advice.request.ratio - whole), 0.5 * 0.05 * 1.05) << whole;
  }
  EXPECT_EQ(advice_for_one_wave(0.525).reason, Reason::chatter_no_better_speed);
}

// A miss of ε waves leaves |1 − e^{2πiε}|/2 = sin πε of the worst regeneration. With 20 waves
// between two teeth a step that leaves a quarter is taken, one that leaves half is not.
TEST(SpeedTable, TheRuleTakesAStepThatLeavesAQuarterOfTheRegenerationNotHalf) {
  const double pi = std::acos(-1.0);
  for (const double left : {0.25, 0.5}) {
    SpeedTable::Config config;
    config.step_ratio = {0.98, 1.0};
    const double miss = std::asin(left) / pi;
    // At 100 % there are 20 waves and this fraction of another.
    const double frequency_hz = 2.0 * 100.0 * (20.0 + miss);
    const auto advice = SpeedTable::make(config)->ask(
        {.programmed_rev_s = 100.0, .ratio = 0.98, .frequency_hz = frequency_hz});
    EXPECT_EQ(advice.reason == Reason::chatter_rule_speed, left < 0.3) << left;
  }
}

TEST(SpeedTable, KeepsTheLimitsForAnyQuestion) {
  SpeedTable::Config config = slot();
  // The spindle's limits, narrower than the table and the panel.
  config.min_rev_s = 70.0;
  config.max_rev_s = 95.0;
  for (const bool with_table : {true, false}) {
    if (!with_table) {
      config.speed_rev_s.clear();
      config.limit_depth_mm.clear();
    }
    const auto table = SpeedTable::make(config);
    ASSERT_TRUE(table);
    for (double speed = 1.0; speed < 400.0; speed *= 1.01) {
      for (const double hz : {0.0, 50.0, 922.0, 4000.0}) {
        const auto advice =
            table->ask({.programmed_rev_s = speed, .depth_mm = 0.5, .frequency_hz = hz});
        if (advice.request.reason != Reason::none) {
          EXPECT_GE(advice.request.ratio * speed, 70.0 - 1e-9);
          EXPECT_LE(advice.request.ratio * speed, 95.0 + 1e-9);
          EXPECT_GE(advice.request.ratio, 0.5 - 1e-9);
          EXPECT_LE(advice.request.ratio, 1.2 + 1e-9);
        } else {
          EXPECT_EQ(advice.request.ratio, 1.0);
        }
      }
    }
  }
}

TEST(SpeedTable, UnfitQuestionsAreNeutral) {
  const auto table = SpeedTable::make(slot());
  ASSERT_TRUE(table);
  EXPECT_EQ(table->ask({.programmed_rev_s = std::nan("")}).request.reason,
            Reason::input_not_finite);
  EXPECT_EQ(table->ask({.programmed_rev_s = -1.0}).request.reason, Reason::input_out_of_range);
  EXPECT_EQ(table->ask({.programmed_rev_s = 80.0, .ratio = 0.0}).request.ratio, 1.0);
}

// A table comes from a file; a search in speeds that do not rise could return anything.
TEST(SpeedTable, RefusesTablesThatAreNotInOrder) {
  SpeedTable::Config config = slot();
  config.limit_depth_mm.pop_back();
  EXPECT_FALSE(SpeedTable::make(config));
  config = slot();
  config.speed_rev_s[2] = config.speed_rev_s[1];
  EXPECT_FALSE(SpeedTable::make(config));
  config = slot();
  config.limit_depth_mm[0] = -1.0;
  EXPECT_FALSE(SpeedTable::make(config));
  config = slot();
  config.step_ratio.clear();
  EXPECT_FALSE(SpeedTable::make(config));
}

}  // namespace
}  // namespace steadyrest::chatter::online
