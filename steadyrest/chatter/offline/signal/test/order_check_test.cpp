// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <cmath>
#include <limits>
#include <random>
#include <vector>

#include <gtest/gtest.h>

#include <steadyrest/chatter/offline/signal/order_check.hpp>
#include <steadyrest/kernel/units/constants.hpp>

namespace steadyrest::chatter::offline {
namespace {

constexpr double kRateHz = 8e3;

/// A cut of 6 s at 53 rev/s: tooth orders, a tenth of them runout, noise, and a line of chatter.
std::vector<double> cut(int teeth, double chatter, double orders = 1.0) {
  std::mt19937_64 rng(9);
  std::normal_distribution<double> noise(0.0, 0.2);
  std::vector<double> out;
  for (int i = 0; i < 6 * static_cast<int>(kRateHz); ++i) {
    const double t = i / kRateHz;
    double value = noise(rng) + chatter * std::cos(kernel::units::kTurn * 911.3 * t);
    for (int k = 1; k <= 30; ++k) {
      const double size = orders * (k % teeth == 0 ? 1.0 : 0.1) / (1.0 + 0.05 * k);
      value += size * std::cos(kernel::units::kTurn * 53.0 * k * t + k * k);
    }
    out.push_back(value);
  }
  return out;
}

TEST(OrderCheck, BelievesWhatIsRight) {
  for (const double told : {53.0, 53.2, 52.4}) {
    const auto found = check_orders(cut(4, 0.5), kRateHz, told, 4);
    EXPECT_TRUE(found.known);
    EXPECT_FALSE(found.other_speed) << told;
    EXPECT_EQ(found.other_teeth, 0U);
    EXPECT_NEAR(found.speed_rev_s, 53.0, 0.05);
  }
}

TEST(OrderCheck, NamesAnotherSpeed) {
  for (const double told : {48.0, 58.5, 64.0}) {
    const auto found = check_orders(cut(4, 0.3), kRateHz, told, 4);
    EXPECT_TRUE(found.other_speed) << told;
    EXPECT_NEAR(found.speed_rev_s, 53.0, 0.05) << told;
  }
}

TEST(OrderCheck, NamesAnotherNumberOfTeeth) {
  EXPECT_EQ(check_orders(cut(3, 0.0), kRateHz, 53.0, 4).other_teeth, 3U);
  EXPECT_EQ(check_orders(cut(5, 0.0), kRateHz, 53.0, 2).other_teeth, 5U);
  EXPECT_EQ(check_orders(cut(4, 0.0), kRateHz, 53.0, 2).other_teeth, 0U) << "multiples of 2 too";
  EXPECT_EQ(check_orders(cut(2, 0.0), kRateHz, 53.0, 2).other_teeth, 0U);
}

// One line of chatter beside weak orders is at order 10 of a speed 4 % higher.
TEST(OrderCheck, DoesNotTakeALineOfChatterForAnOrder) {
  std::mt19937_64 rng(4);
  for (int i = 0; i < 200; ++i) {
    const double told = std::uniform_real_distribution<double>(20.0, 120.0)(rng);
    std::vector<double> value;
    std::normal_distribution<double> noise(0.0, 0.02);
    for (int n = 0; n < 2 * static_cast<int>(kRateHz); ++n) {
      const double turns = told * n / kRateHz;
      value.push_back(noise(rng) + std::cos(kernel::units::kTurn * 10.4 * turns) +
                      0.3 * std::cos(kernel::units::kTurn * 14.4 * turns) +
                      0.02 * std::cos(kernel::units::kTurn * 4.0 * turns));
    }
    EXPECT_FALSE(check_orders(value, kRateHz, told, 4).other_speed) << told;
  }
}

// Cutters of 53 and of 71.5 rev/s one after the other, the file says 53; then 3 teeth and 4.
TEST(OrderCheck, NamesTheSecondToolOfAFile) {
  std::vector<double> value = cut(4, 0.3);
  for (int i = 0; i < 6 * static_cast<int>(kRateHz); ++i) {
    double sum = 0.0;
    for (int k = 1; k <= 30; ++k) {
      sum += (k % 4 == 0 ? 1.0 : 0.1) / (1.0 + 0.05 * k) *
             std::cos(kernel::units::kTurn * 71.5 * k * i / kRateHz + k * k);
    }
    value.push_back(sum);
  }
  const std::vector<double> told(value.size(), 53.0);
  const auto other = other_cuts(value, told, kRateHz, 4);
  ASSERT_EQ(other.size(), 1U);
  EXPECT_NEAR(other[0].speed_rev_s, 71.5, 0.05);
  EXPECT_NEAR(static_cast<double>(other[0].begin) / kRateHz, 6.0, 1.0);
  EXPECT_EQ(other[0].end, value.size());

  std::vector<double> teeth = cut(3, 0.0);
  const std::vector<double> second = cut(4, 0.0);
  teeth.insert(teeth.end(), second.begin(), second.end());
  const auto three = other_cuts(teeth, told, kRateHz, 4);
  ASSERT_EQ(three.size(), 1U);
  EXPECT_EQ(three[0].other_teeth, 3U);
  EXPECT_EQ(three[0].speed_rev_s, 0.0);
  EXPECT_EQ(three[0].begin, 0U);
  EXPECT_TRUE(other_cuts(second, told, kRateHz, 4).empty());
}

// A spindle that runs up, and two speeds, as the column says: nothing is wrong.
TEST(OrderCheck, AsksOnlyWhereTheStatedSpeedIsConstant) {
  std::vector<double> told(static_cast<std::size_t>(6.0 * kRateHz), 53.0);
  EXPECT_EQ(constant_speed(told), 53.0);
  for (std::size_t i = 0; i < told.size() / 3; ++i) {
    told[i] = 53.0 * 3.0 * static_cast<double>(i) / static_cast<double>(told.size());
  }
  EXPECT_EQ(constant_speed(told), 0.0);
  EXPECT_TRUE(other_cuts(cut(4, 0.3), told, kRateHz, 4).empty());
  std::ranges::fill(told, std::numeric_limits<double>::quiet_NaN());
  EXPECT_EQ(constant_speed(told), 0.0);
}

// A cut that only chatters, air, and less than a window say nothing.
TEST(OrderCheck, SaysNothingWhereNoOrdersStandOut) {
  EXPECT_FALSE(check_orders(cut(4, 3.0, 0.05), kRateHz, 48.0, 4).other_speed);
  EXPECT_FALSE(check_orders(cut(4, 0.0, 0.0), kRateHz, 48.0, 4).known);
  EXPECT_FALSE(check_orders(std::vector<double>(4000, 0.1), kRateHz, 48.0, 4).known);
}

}  // namespace
}  // namespace steadyrest::chatter::offline
