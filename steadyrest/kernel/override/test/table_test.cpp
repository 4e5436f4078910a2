// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <bit>
#include <cmath>
#include <map>

#include <gtest/gtest.h>
#include <rapidcheck.h>
#include <rapidcheck/gtest.h>

#include <steadyrest/kernel/override/gray.hpp>
#include <steadyrest/kernel/override/table.hpp>
#include <steadyrest/kernel/override/test/published_tables.hpp>
#include <steadyrest/kernel/units/constants.hpp>

namespace steadyrest::kernel::override {
namespace {

using units::kInfinity;
using units::kNan;

// Oracle: Siemens' list of switch settings, not our formula.
TEST(Gray, PublishedSwitchPositions) {
  // HT2 rotary switch, settings 0–3 and 14–18.
  const std::map<std::size_t, std::uint32_t> published = {
      {0, 0b00001},  {1, 0b00011},  {2, 0b00010},  {3, 0b00110}, {14, 0b01000},
      {15, 0b11000}, {16, 0b11001}, {17, 0b11011}, {18, 0b11010}};
  for (const auto& [index, code] : published) {
    EXPECT_EQ(sinumerik_code(index), code) << index;
  }
}

// Gray's definition: one bit between neighbours, at any position of 32 bits.
RC_GTEST_PROP(Gray, PositionIsTheInverseAndNeighboursDifferInOneBit, (std::uint32_t position)) {
  RC_ASSERT(gray_position(gray_code(position)) == position);
  RC_ASSERT(std::popcount(gray_code(position) ^ gray_code(position + 1)) == 1);
}

// The whole published switch, code by code: 23 settings in rising order.
TEST(OverrideTable, FeedSwitchOf840dReadsAsPublished) {
  const auto table = Table::make(test::feed_840d());
  ASSERT_TRUE(table);
  ASSERT_EQ(table->steps(), 23U);
  const std::map<std::uint32_t, double> published = {
      {0x01, 0.0}, {0x03, 0.01}, {0x02, 0.02}, {0x06, 0.04}, {0x07, 0.06}, {0x05, 0.08},
      {0x04, 0.1}, {0x0C, 0.2},  {0x0D, 0.3},  {0x0F, 0.4},  {0x0E, 0.5},  {0x0A, 0.6},
      {0x0B, 0.7}, {0x09, 0.75}, {0x08, 0.8},  {0x18, 0.85}, {0x19, 0.9},  {0x1B, 0.95},
      {0x1A, 1.0}, {0x1E, 1.05}, {0x1F, 1.1},  {0x1D, 1.15}, {0x1C, 1.2}};
  for (const auto& [code, ratio] : published) {
    const auto step = table->step_of_code(code);
    ASSERT_TRUE(step) << code;
    EXPECT_DOUBLE_EQ(table->ratio(*step), ratio) << code;
    EXPECT_EQ(table->code(*step), code);
  }
}

TEST(OverrideTable, SpindleSwitchOf840dReadsAsPublished) {
  const auto table = Table::make(test::spindle_840d());
  ASSERT_TRUE(table);
  ASSERT_EQ(table->steps(), 15U);
  const std::map<std::uint32_t, double> published = {
      {0b00001, 0.50}, {0b00011, 0.55}, {0b00010, 0.60}, {0b00110, 0.65}, {0b00111, 0.70},
      {0b00101, 0.75}, {0b00100, 0.80}, {0b01100, 0.85}, {0b01101, 0.90}, {0b01111, 0.95},
      {0b01110, 1.00}, {0b01010, 1.05}, {0b01011, 1.10}, {0b01001, 1.15}, {0b01000, 1.20}};
  for (const auto& [code, ratio] : published) {
    const auto step = table->step_of_code(code);
    ASSERT_TRUE(step) << code;
    EXPECT_DOUBLE_EQ(table->ratio(*step), ratio) << code;
  }
}

// Three readings of two panels: a code alone means nothing.
TEST(OverrideTable, TheSameCodeMeansAnotherRatioOnAnotherMachine) {
  const auto panel = Table::make(test::feed_840d());
  const auto dmg = Table::make(test::feed_dmg());
  ASSERT_TRUE(panel);
  ASSERT_TRUE(dmg);
  ASSERT_EQ(dmg->steps(), 31U);
  EXPECT_DOUBLE_EQ(panel->ratio(panel->step_of_code(0b11010).value()), 1.0);
  EXPECT_DOUBLE_EQ(dmg->ratio(dmg->step_of_code(0b11010).value()), 0.70);
  EXPECT_DOUBLE_EQ(dmg->ratio(dmg->step_of_code(0b10101).value()), 1.0);
}

// Codes from wiring faults: none, all, one bit too many, a position that does not exist.
TEST(OverrideTable, UnknownCodeIsNeverGuessed) {
  const auto table = Table::make(test::feed_840d());
  ASSERT_TRUE(table);
  EXPECT_FALSE(table->step_of_code(0));     // an open cable
  EXPECT_FALSE(table->step_of_code(0x10));  // position 31: not on this switch
  EXPECT_FALSE(table->step_of_code(0x3A));  // 100 % with bit 5 set
  EXPECT_FALSE(table->step_of_code(0xFFFFFFFF));
}

// 7·0.1 and 1 − 0.3 are not 0.7 in binary; both must find its step.
TEST(OverrideTable, FloorNearestAndBounds) {
  const auto table = Table::make(test::feed_840d());
  ASSERT_TRUE(table);
  EXPECT_EQ(table->floor_step(0.699), 11U);
  EXPECT_EQ(table->floor_step(0.7), 12U);
  EXPECT_EQ(table->floor_step(7 * 0.1), 12U);
  EXPECT_EQ(table->floor_step(1.0 - 0.3), 12U);  // 0.7 less a rounding error
  EXPECT_EQ(table->floor_step(99.0), 22U);
  EXPECT_EQ(table->floor_step(kInfinity), 22U);
  EXPECT_FALSE(table->floor_step(-0.01));
  EXPECT_FALSE(table->floor_step(kNan));
  EXPECT_EQ(table->ceil_step(0.701), 13U);
  EXPECT_FALSE(table->ceil_step(1.21));
  EXPECT_FALSE(table->ceil_step(kNan));
  EXPECT_EQ(table->nearest_step(0.67), 12U);
  EXPECT_EQ(table->nearest_step(0.64), 11U);
  EXPECT_EQ(table->nearest_step(5.0), 22U);
  EXPECT_EQ(table->nearest_step(-5.0), 0U);
  EXPECT_FALSE(table->nearest_step(kNan));
  EXPECT_DOUBLE_EQ(table->min_ratio(), 0.0);
  EXPECT_DOUBLE_EQ(table->max_ratio(), 1.2);
}

TEST(OverrideTable, SpindleFloorBelowTheLowestStepIsNothing) {
  const auto table = Table::make(test::spindle_840d());
  ASSERT_TRUE(table);
  EXPECT_FALSE(table->floor_step(0.49));
  EXPECT_EQ(table->ceil_step(0.49), 0U);
}

// Steps above the clip are all the same to the control; a search finds the lowest of them, while
// every code still reads back as its own step.
TEST(OverrideTable, ControlClipsAtItsMaximum) {
  auto config = test::feed_dmg();
  config.max_ratio = 1.2;
  const auto table = Table::make(config);
  ASSERT_TRUE(table);
  EXPECT_DOUBLE_EQ(table->max_ratio(), 1.2);
  EXPECT_EQ(table->floor_step(2.0), 28U) << "the lowest of the steps that give 120 %";
  EXPECT_EQ(table->step_of_code(sinumerik_code(30)), 30U);
}

// A word of percent: 100 is 01100100, 201 is beyond the table.
TEST(OverrideTable, BinaryWordAsPercent) {
  const auto table = Table::make(test::percent_word());
  ASSERT_TRUE(table);
  EXPECT_EQ(table->step_of_code(0b01100100), 100U);
  EXPECT_DOUBLE_EQ(table->ratio(100), 1.0);
  EXPECT_FALSE(table->step_of_code(201));
}

struct BadTable {
  const char* fault;
  machine::OverrideTable table;
};

// One fault each, named by the words that the refusal must contain.
std::vector<BadTable> bad_tables() {
  using machine::Coding;
  std::vector<BadTable> bad;
  const auto add = [&](const char* fault, auto&& spoil) {
    auto table = test::feed_840d();
    spoil(table);
    bad.push_back({.fault = fault, .table = table});
  };
  add("no steps", [](auto& t) { t.ratio.clear(); });
  add("has ratio nan", [](auto& t) { t.ratio[3] = kNan; });
  add("has ratio inf", [](auto& t) { t.ratio[22] = machine::kUnlimited; });
  add("has ratio -0.1", [](auto& t) { t.ratio[0] = -0.1; });
  add("less than", [](auto& t) { t.ratio[4] = 0.01; });
  add("23 ratios and 0 codes", [](auto& t) { t.coding = Coding::binary; });
  add("23 ratios and 2 codes", [](auto& t) { t.code = {1, 3}; });
  add("differ in", [](auto& t) {
    for (std::uint32_t i = 0; i < 23; ++i) t.code.push_back(i);
  });
  add("same code", [](auto& t) {
    t.ratio = {0.0, 0.5, 1.0};
    t.code = {1, 3, 1};
  });
  add("same code", [](auto& t) {
    t.coding = Coding::binary;
    t.ratio = {0.0, 0.5, 1.0};
    t.code = {7, 2, 7};
  });
  add("max_ratio", [](auto& t) { t.max_ratio = 0.0; });
  add("max_ratio", [](auto& t) { t.max_ratio = kNan; });
  add("a time", [](auto& t) { t.scan_period_s = -0.01; });
  add("a time", [](auto& t) { t.dead_time_s = kNan; });
  return bad;
}

TEST(OverrideTable, RefusesWhatIsNoTable) {
  for (const auto& [fault, config] : bad_tables()) {
    const auto table = Table::make(config);
    ASSERT_FALSE(table) << fault;
    EXPECT_NE(table.error().what.find(fault), std::string::npos) << table.error().what;
    EXPECT_FALSE(table.error().to_do.empty());
  }
}

// Any ascending table, any wish: no step at or below the wish is larger than the one found.
RC_GTEST_PROP(OverrideTable, FloorIsTheLargestStepNotAbove, ()) {
  auto percent = *rc::gen::nonEmpty(rc::gen::container<std::vector<int>>(rc::gen::inRange(0, 250)));
  std::ranges::sort(percent);
  machine::OverrideTable config;
  for (const int p : percent) {
    config.ratio.push_back(p / 100.0);
  }
  const auto table = Table::make(config);
  RC_ASSERT(table.has_value());
  const double wish = *rc::gen::inRange(0, 3000) / 1000.0;
  const auto step = table->floor_step(wish);
  for (std::size_t i = 0; i < table->steps(); ++i) {
    if (table->ratio(i) <= wish) {
      RC_ASSERT(step.has_value());
      RC_ASSERT(table->ratio(i) <= table->ratio(*step));
    }
  }
  if (step) {
    RC_ASSERT(table->ratio(*step) <= wish + kRatioTolerance);
  }
}

}  // namespace
}  // namespace steadyrest::kernel::override
