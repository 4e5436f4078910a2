// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <cmath>
#include <vector>

#include <gtest/gtest.h>
#include <rapidcheck.h>
#include <rapidcheck/gtest.h>

#include <steadyrest/contour/online/search/objective_search.hpp>

namespace steadyrest::contour::online {
namespace {

constexpr std::size_t kExhaustive = 32;

struct Found {
  std::size_t best = 0;
  std::size_t looks = 0;
};

Found search(const std::vector<double>& value, std::size_t exhaustive = kExhaustive) {
  ObjectiveSearch search;
  Found found;
  for (search.begin(value.size(), exhaustive); !search.done(); ++found.looks) {
    search.tell(value.at(search.next()), 1e-9);
  }
  found.best = search.best();
  return found;
}

TEST(ObjectiveSearch, IsDoneUntilItBegins) {
  EXPECT_TRUE(ObjectiveSearch{}.done());
}

// A valley has one bottom; with 64 steps 14 looks must find it, wherever it lies, with 201 not many
// more.
TEST(ObjectiveSearch, FindsTheBottomOfAValleyInFewLooks) {
  for (const std::size_t steps : {1U, 2U, 7U, 32U, 33U, 40U, 63U, 64U, 65U, 121U, 201U, 256U}) {
    for (std::size_t bottom = 0; bottom < steps; ++bottom) {
      std::vector<double> value(steps);
      for (std::size_t i = 0; i < steps; ++i) {
        value[i] = std::abs(static_cast<double>(i) - static_cast<double>(bottom));
      }
      const Found found = search(value);
      EXPECT_EQ(found.best, bottom) << steps;
      EXPECT_LE(found.looks, steps <= kExhaustive ? steps : steps <= 64U ? 14U : 18U) << steps;
      EXPECT_EQ(search(value, steps).best, bottom);
    }
  }
}

// Where the error does not tell steps apart the faster one wins: level objectives occur on lines.
TEST(ObjectiveSearch, AmongEqualsTakesTheHighestStep) {
  EXPECT_EQ(search(std::vector<double>(23, 1.0)).best, 22U);
  EXPECT_EQ(search(std::vector<double>(64, 1.0)).best, 63U);
}

RC_GTEST_PROP(ObjectiveSearch, OfAFewStepsLooksAtAllWhateverTheirValues, ()) {
  const auto value = *rc::gen::container<std::vector<double>>(
      *rc::gen::inRange<std::size_t>(1, kExhaustive + 1), rc::gen::arbitrary<double>());
  RC_PRE(std::ranges::none_of(value, [](double v) { return std::isnan(v); }));
  const Found found = search(value);
  RC_ASSERT(found.looks == value.size());
  RC_ASSERT(value[found.best] <= *std::ranges::min_element(value) + 1e-9);
}

}  // namespace
}  // namespace steadyrest::contour::online
