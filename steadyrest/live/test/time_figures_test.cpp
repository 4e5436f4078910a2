// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <cmath>
#include <limits>
#include <vector>

#include <gtest/gtest.h>
#include <rapidcheck/gtest.h>

#include <steadyrest/live/time_figures.hpp>

namespace steadyrest::live {
namespace {

TEST(TimeFigures, AreZeroWithoutTimes) {
  EXPECT_EQ(TimeFigures().quantile_s(0.5), 0.0);
  EXPECT_EQ(TimeFigures().count(), 0U);
}

RC_GTEST_PROP(TimeFigures, QuantilesAreWithinABin, ()) {
  const auto exponents =
      *rc::gen::nonEmpty(rc::gen::container<std::vector<int>>(rc::gen::inRange(-6900, 900)));
  std::vector<double> times;
  TimeFigures figures;
  for (const int exponent : exponents) {
    times.push_back(std::pow(10.0, 1e-3 * exponent));
    figures.add(times.back());
  }
  std::ranges::sort(times);
  RC_ASSERT(figures.largest_s() == times.back());
  for (const double share : {0.5, 0.9, 0.999}) {
    const auto rank = static_cast<std::size_t>(
        std::max(1.0, std::ceil(share * static_cast<double>(times.size()))));
    const double quantile = times[rank - 1];
    RC_ASSERT(figures.quantile_s(share) >= quantile * (1.0 - 1e-9));
    RC_ASSERT(figures.quantile_s(share) <= quantile * 1.045);
  }
}

TEST(TimeFigures, TakeAnything) {
  TimeFigures figures;
  figures.add(-1.0);
  figures.add(0.0);
  figures.add(1e9);
  figures.add(std::numeric_limits<double>::quiet_NaN());
  figures.add(std::numeric_limits<double>::infinity());
  EXPECT_EQ(figures.count(), 5U);
  EXPECT_LE(figures.quantile_s(0.3), 2e-7);
}

}  // namespace
}  // namespace steadyrest::live
