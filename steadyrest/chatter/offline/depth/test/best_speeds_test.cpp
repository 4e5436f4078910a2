// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <cmath>

#include <gtest/gtest.h>

#include <steadyrest/chatter/offline/depth/best_speeds.hpp>
#include <steadyrest/chatter/offline/depth/limit_depth.hpp>
#include <steadyrest/chatter/offline/test/cuts.hpp>
#include <steadyrest/kernel/testing/cases.hpp>

namespace steadyrest::chatter::offline::test {
namespace {

using kernel::testing::cases;
using kernel::testing::kSanitized;

constexpr double kMost_mm = 10.0;

double border_mm(const Process& process, double speed_rev_s) {
  return limit_depth_mm(process, speed_rev_s, {}, kMost_mm).value().value_or(kMost_mm);
}

/// Lowest border within the tolerance, by brute force.
double sure_mm(const Process& process, double speed_rev_s, double tolerance) {
  double out = kMost_mm;
  for (int i = -20; i <= 20; ++i) {
    out = std::min(out, border_mm(process, speed_rev_s * (1.0 + tolerance * i / 20.0)));
  }
  return out;
}

TEST(BestSpeeds, AreTheDeepestOfTheSpindleAndRanked) {
  for (const double immersion : cases({1.0, 0.5})) {
    const Process cut = benchmark_cut(immersion, Direction::down);
    const BestSpeedsConfig config{
        .min_rev_s = 3000.0 / 60.0, .max_rev_s = 15000.0 / 60.0, .most_depth_mm = kMost_mm};
    const auto best = best_speeds(cut, config);
    ASSERT_TRUE(best.has_value());
    ASSERT_GE(best->size(), 2U);
    ASSERT_LE(best->size(), 5U);
    double last = kMost_mm;
    for (const BestSpeed& one : *best) {
      EXPECT_GE(one.speed_rev_s, config.min_rev_s);
      EXPECT_LE(one.speed_rev_s, config.max_rev_s);
      EXPECT_NEAR(one.limit_depth_mm.value_or(kMost_mm), border_mm(cut, one.speed_rev_s), 1e-6);
      const double sure = one.sure_depth_mm.value_or(kMost_mm);
      EXPECT_LE(sure, last * (1.0 + 1e-9));
      // The border line is within 1 % of the depth and 0.05 % of the greatest; twice that for a
      // minimum.
      EXPECT_NEAR(sure, sure_mm(cut, one.speed_rev_s, 0.01), 0.02 * sure + 0.01);
      last = sure;
    }
    // No other speed holds more.
    const double most = best->front().sure_depth_mm.value_or(kMost_mm);
    // A step that shares no factor with the lobes, so that it does not miss every cusp.
    for (double rpm = 3100.0; rpm < 14900.0; rpm += kSanitized ? 3007.0 : 97.0) {
      EXPECT_LE(sure_mm(cut, rpm / 60.0, 0.01), 1.03 * most + 0.01) << rpm;
    }
  }
}

TEST(BestSpeeds, OfASpindleBeyondReachAreNone) {
  const auto best = best_speeds(benchmark_cut(1.0, Direction::up),
                                {.min_rev_s = 0.01, .max_rev_s = 0.1, .most_depth_mm = kMost_mm});
  ASSERT_TRUE(best.has_value());
  EXPECT_TRUE(best->empty());
}

TEST(BestSpeeds, OfASlowSpindleLieInItsUpperFifth) {
  const auto best =
      best_speeds(benchmark_cut(1.0, Direction::up),
                  {.min_rev_s = 0.0, .max_rev_s = 900.0 / 60.0, .most_depth_mm = 1.0});
  ASSERT_TRUE(best.has_value());
  ASSERT_FALSE(best->empty());
  for (const BestSpeed& one : *best) {
    // 80 % of 900 rpm: below, all lobes are too narrow to aim at.
    EXPECT_GE(one.speed_rev_s, 720.0 / 60.0);
    EXPECT_LE(one.speed_rev_s, 900.0 / 60.0);
    EXPECT_GT(one.limit_depth_mm.value(), 0.3);
  }
}

}  // namespace
}  // namespace steadyrest::chatter::offline::test
