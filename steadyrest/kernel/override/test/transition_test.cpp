// SPDX-License-Identifier: Apache-2.0
#include <bit>
#include <set>

#include <gtest/gtest.h>
#include <rapidcheck.h>
#include <rapidcheck/gtest.h>

#include <steadyrest/kernel/override/test/published_tables.hpp>
#include <steadyrest/kernel/override/transition.hpp>
#include <steadyrest/kernel/units/constants.hpp>

namespace steadyrest::kernel::override {
namespace {

/// Every word that a reader may see while `from` becomes `to` bit by bit in any order, by brute
/// force.
std::set<std::uint32_t> words_between(std::uint32_t from, std::uint32_t to) {
  std::set<std::uint32_t> words = {from};
  for (std::uint32_t bit = 1; bit != 0; bit <<= 1U) {
    if (((from ^ to) & bit) != 0) {
      std::set<std::uint32_t> more;
      for (const auto word : words) {
        more.insert(word ^ bit);
      }
      words.merge(more);
    }
  }
  return words;
}

bool all_inside(const Table& table, std::size_t from, std::size_t to) {
  const auto ends = std::minmax({table.ratio(from), table.ratio(to)});
  const auto inside = [&table, ends](auto word) {
    const auto step = table.step_of_code(word);
    return step && table.ratio(*step) >= ends.first && table.ratio(*step) <= ends.second;
  };
  return std::ranges::all_of(words_between(table.code(from), table.code(to)), inside);
}

class Published : public ::testing::TestWithParam<machine::OverrideTable> {};

// All pairs of four published tables against enumeration: the product's count must agree with it.
TEST_P(Published, ChangeIsSafeExactlyWhenBruteForceSaysSo) {
  const auto table = Table::make(GetParam());
  ASSERT_TRUE(table);
  for (std::size_t from = 0; from < table->steps(); ++from) {
    for (std::size_t to = 0; to < table->steps(); ++to) {
      ASSERT_EQ(change_is_safe(*table, from, to), all_inside(*table, from, to))
          << from << " → " << to;
    }
  }
}

INSTANTIATE_TEST_SUITE_P(Tables, Published,
                         ::testing::Values(test::feed_840d(), test::spindle_840d(),
                                           test::feed_dmg(), test::percent_word()));

TEST(Transition, ADistantGrayJumpMayStopTheFeed) {
  // 70 % = 01011 to 80 % = 01000: through 01001 (75 %) it is safe, but the bits may also pass
  // 01010 = 60 %.
  const auto table = Table::make(test::feed_840d());
  ASSERT_TRUE(table);
  EXPECT_TRUE(change_is_safe(*table, 12, 13));
  EXPECT_FALSE(change_is_safe(*table, 12, 14));
}

// 1 % → 2 % in binary is 01 → 10: two bits.
TEST(Transition, BinaryWordIsRefusedUnlessLatched) {
  const auto table = Table::make(test::percent_word());
  ASSERT_TRUE(table);
  const auto walked = Stepper::make(*table, {.latched = false});
  ASSERT_FALSE(walked);
  EXPECT_NE(walked.error().what.find("0b1 (1 %) and 0b10 (2 %) differ in 2 bits"),
            std::string::npos)
      << walked.error().what;
  EXPECT_FALSE(walked.error().to_do.empty());

  auto latched = Stepper::make(*table, {.latched = true});
  ASSERT_TRUE(latched);
  EXPECT_EQ(latched->update(150), 150U) << "one latched word";
  EXPECT_EQ(latched->update(20), 20U);
}

TEST(Transition, RefusesAScanPeriodThatIsNone) {
  const auto table = Table::make(test::feed_840d());
  ASSERT_TRUE(table);
  EXPECT_FALSE(Stepper::make(*table, {.latched = false, .scan_period_s = -1.0}));
  EXPECT_FALSE(Stepper::make(*table, {.latched = true, .scan_period_s = units::kNan}));
}

// Scans of 10 ms; the first word must also settle before the walk starts.
TEST(Stepper, WalksOneNeighbourForEachScan) {
  const auto table = Table::make(test::feed_840d());
  ASSERT_TRUE(table);
  auto stepper = Stepper::make(*table, {.latched = false, .scan_period_s = 0.01});
  ASSERT_TRUE(stepper);
  std::vector<std::size_t> seen;
  for (int ms = 0; ms <= 60; ++ms) {
    stepper->pass(0.001);
    const auto step = stepper->update(3);
    if (seen.empty() || seen.back() != step) {
      seen.push_back(step);
    }
  }
  EXPECT_EQ(seen, (std::vector<std::size_t>{0, 1, 2, 3}));
  EXPECT_NEAR(stepper->state().stood_s, 0.030, 1e-9) << "a scan for each, the first word too";
}

TEST(Stepper, ATargetBeyondTheTableIsItsLastStep) {
  const auto table = Table::make(test::feed_840d());
  ASSERT_TRUE(table);
  auto stepper = Stepper::make(*table, {.latched = true});
  ASSERT_TRUE(stepper);
  EXPECT_EQ(stepper->update(1000), 22U);
}

// 9 ms and 1 ms of good time make one scan; NaN, infinity and time running back make none.
TEST(Stepper, TimeThatIsNoneNeitherHurriesNorDelays) {
  const auto table = Table::make(test::feed_840d());
  ASSERT_TRUE(table);
  auto stepper = Stepper::make(*table, {.latched = false, .scan_period_s = 0.01});
  ASSERT_TRUE(stepper);
  const auto cycle = [&](double step_s) {
    stepper->pass(step_s);
    return stepper->update(5);
  };
  EXPECT_EQ(cycle(9.99), 0U) << "before the first word nothing counts";
  EXPECT_EQ(cycle(0.010), 1U);
  EXPECT_EQ(cycle(units::kNan), 1U);
  EXPECT_EQ(cycle(units::kInfinity), 1U);
  EXPECT_EQ(cycle(0.009), 1U);
  EXPECT_EQ(cycle(-7.0), 1U);
  EXPECT_EQ(cycle(0.0), 1U);
  EXPECT_EQ(cycle(0.001), 2U) << "a whole scan of good time, neither sooner nor later";
}

// From any step to any other on any table: no mixture of bits may lie outside the two ends, no word
// is shorter than a scan, and the walk arrives.
RC_GTEST_PROP(Stepper, NoIntermediateWordDecodesOutsideOfFromAndTo, ()) {
  const auto config = *rc::gen::element(test::feed_840d(), test::spindle_840d(), test::feed_dmg());
  const auto table = Table::make(config);
  RC_ASSERT(table.has_value());
  auto stepper = Stepper::make(*table, {.latched = false, .scan_period_s = 0.01});
  RC_ASSERT(stepper.has_value());
  const auto from = *rc::gen::inRange<std::size_t>(0, table->steps());
  const auto to = *rc::gen::inRange<std::size_t>(0, table->steps());
  const int cycle_ms = *rc::gen::inRange(1, 30);
  stepper->place(from);
  const auto [low, high] = std::minmax({table->ratio(from), table->ratio(to)});
  double time_s = 0.0;
  double word_since_s = 0.0;
  std::size_t before = from;
  for (int i = 0; i < 30 * 31 && before != to; ++i) {
    time_s += 0.001 * cycle_ms;
    stepper->pass(0.001 * cycle_ms);
    const auto step = stepper->update(to);
    for (const auto word : words_between(table->code(before), table->code(step))) {
      const auto seen = table->step_of_code(word);
      RC_ASSERT(seen.has_value());
      RC_ASSERT(table->ratio(*seen) >= low);
      RC_ASSERT(table->ratio(*seen) <= high);
    }
    if (step != before) {
      RC_ASSERT(time_s - word_since_s >= 0.01 - 1e-6);
      word_since_s = time_s;
    }
    before = step;
  }
  RC_ASSERT(before == to);
}

}  // namespace
}  // namespace steadyrest::kernel::override
