// SPDX-License-Identifier: Apache-2.0
#include <cmath>
#include <vector>

#include <gtest/gtest.h>
#include <rapidcheck.h>
#include <rapidcheck/gtest.h>

#include <steadyrest/contour/online/search/step_search.hpp>

namespace steadyrest::contour::online {
namespace {

constexpr auto kAlways = [] { return true; };

std::optional<std::size_t> exhaustive(const std::vector<bool>& good, std::size_t top) {
  for (std::size_t step = top + 1; step-- > 0;) {
    if (good[step]) {
      return step;
    }
  }
  return std::nullopt;
}

// All tables whose good steps are the lowest ones, every start, every top: the two searches must
// agree, at most 2·log₂ n + 2 looks each.
TEST(StepSearch, WhereSlowerIsAdmissibleTooItIsTheExhaustiveChoiceInFewLooks) {
  for (const std::size_t steps : {1U, 2U, 23U, 33U, 64U}) {
    const double most = 2.0 * std::log2(static_cast<double>(steps)) + 2.0;
    for (std::size_t border = 0; border <= steps; ++border) {
      std::vector<bool> good(steps, false);
      std::fill_n(good.begin(), border, true);
      for (std::size_t start = 0; start < steps; ++start) {
        for (std::size_t top = start; top < steps; ++top) {
          int looks = 0;
          const auto look = [&](std::size_t c) { return ++looks, good[c]; };
          ASSERT_EQ(largest_admissible_near(start, top, look, kAlways), exhaustive(good, top))
              << steps << " " << border << " " << start;
          ASSERT_LE(looks, most);
          ASSERT_EQ(first_admissible_below(top, look, kAlways), exhaustive(good, top));
        }
      }
    }
  }
}

TEST(StepSearch, WhereNothingChangesTwoLooksAreEnough) {
  int looks = 0;
  const auto found =
      largest_admissible_near(40, 63, [&](std::size_t c) { return ++looks, c <= 40; }, kAlways);
  EXPECT_EQ(found, 40U);
  EXPECT_EQ(looks, 2);
}

// No order among the steps, and a stop at any moment: what is returned is admissible or nothing.
RC_GTEST_PROP(StepSearch, WhatItFindsIsAdmissibleHoweverTheStepsLieAndWhenItMustStop, ()) {
  const auto good = *rc::gen::container<std::vector<bool>>(*rc::gen::inRange<std::size_t>(1, 65),
                                                           rc::gen::arbitrary<bool>());
  const auto top = *rc::gen::inRange<std::size_t>(0, good.size());
  const auto start = *rc::gen::inRange<std::size_t>(0, good.size());
  const int most = *rc::gen::inRange(1, 70);
  for (const bool all : {false, true}) {
    int looks = 0;
    const auto look = [&](std::size_t c) { return ++looks, good[c]; };
    const auto may_go_on = [&] { return looks < most; };
    const auto found = all ? first_admissible_below(top, look, may_go_on)
                           : largest_admissible_near(start, top, look, may_go_on);
    RC_ASSERT(looks <= most);
    RC_ASSERT(!found || (*found <= top && good[*found]));
    RC_ASSERT(!found || *found <= *exhaustive(good, top));
    if (all && most > 64) {
      RC_ASSERT(found == exhaustive(good, top));
    }
  }
}

}  // namespace
}  // namespace steadyrest::contour::online
