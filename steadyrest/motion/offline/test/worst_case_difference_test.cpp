// SPDX-License-Identifier: Apache-2.0
#include <cmath>
#include <random>

#include <gtest/gtest.h>

#include <steadyrest/motion/offline/test/scenes.hpp>
#include <steadyrest/motion/online/estimator/worst_case_difference.hpp>

namespace steadyrest::motion::offline::test {
namespace {

using online::WorstCaseDifference;

double published_bound(double noise_mm, double limit, double cycle_s) {
  return 2.0 * std::sqrt(2.0 * noise_mm * limit) + 0.5 * limit * cycle_s;
}

// Published: 2√(2N̄L) + L·T/2 (Haimovich et al. 2021). Ours is the tighter 2N̄/W + L·W of its
// longest window.
TEST(WorstCaseDifference, ItsBoundHoldsOnEveryTickAndIsNeverAboveThePublishedOne) {
  for (const Record* record : {&sine_ideal(), &s_curve_ideal()}) {
    WorstCaseDifference::Config config;
    config.max_acceleration_mm_s2 = record->max_acceleration_mm_s2;
    const Score s = scored<WorstCaseDifference>(config, *record, 0.0, 0.1);
    EXPECT_EQ(s.velocity_coverage, 1.0);
    EXPECT_EQ(s.acceleration_coverage, 1.0);
    const double published = published_bound(0.0005, record->max_acceleration_mm_s2, 0.001);
    EXPECT_LE(s.velocity_bound_mm_s, published);
    EXPECT_GE(s.velocity_bound_mm_s, 0.8 * published);
    EXPECT_LE(s.velocity_max_mm_s, s.velocity_bound_mm_s);
    EXPECT_GE(s.velocity_max_mm_s, 0.4 * s.velocity_bound_mm_s) << "the bound would be slack";
  }
}

TEST(WorstCaseDifference, ItsBoundHoldsWithLineErrorsJitterAndFromTheFirstTickOn) {
  std::mt19937_64 random(3);
  for (std::uint64_t seed = 1; seed <= 40; ++seed) {
    std::uniform_real_distribution<double> share(0.0, 1.0);
    Recording how = line_errors();
    how.seed = seed;
    how.tick_jitter_s = 1e-4 * share(random);
    const Record record =
        offline::record(offline::sine(2.0 * share(random), 1.0 + 9.0 * share(random), 0.4), how);
    WorstCaseDifference::Config config;
    config.max_acceleration_mm_s2 = record.max_acceleration_mm_s2;
    config.line_error_mm = (0.05 + 4.0 * 0.02) * how.count_mm;  // a pattern of 5 % and 4 σ of 2 %
    const Score s = scored<WorstCaseDifference>(config, record, 0.0, 0.0);
    EXPECT_EQ(s.velocity_coverage, 1.0) << seed;
    EXPECT_EQ(s.acceleration_coverage, 1.0) << seed;
  }
}

TEST(WorstCaseDifference, TheBoundIsAtMostThePublishedOneForAnyLimit) {
  for (double limit = 1.0; limit < 1e6; limit *= 1.7) {
    WorstCaseDifference::Config config;
    config.max_acceleration_mm_s2 = limit;
    WorstCaseDifference estimator = WorstCaseDifference::make(config).value();
    Estimate e;
    for (int k = 0; k <= 64; ++k) {
      e = estimator.tick({k * 0.001, 0, 0.0, 0.001});
    }
    EXPECT_LE(e.velocity_bound_mm_s, published_bound(0.0005, limit, 0.001) * (1.0 + 1e-12))
        << limit;
  }
}

TEST(WorstCaseDifference, WithoutVisibleErrorItIsTheLastDifference) {
  // Whole counts along a parabola within the limit: N̂ = 0, window of one tick.
  WorstCaseDifference estimator =
      WorstCaseDifference::make({.max_acceleration_mm_s2 = 2000.0}).value();
  for (std::int64_t k = 0; k < 50; ++k) {
    const double low = static_cast<double>(k * k) * 0.001;
    const Estimate e = estimator.tick({static_cast<double>(k) * 0.001, k * k, low, low + 0.001});
    if (k > 0) {
      EXPECT_NEAR(e.velocity_mm_s, 2.0 * static_cast<double>(k) - 1.0, 1e-9);
    }
  }
}

TEST(WorstCaseDifference, OneStrayCountWidensTheWindowToThePaperSFormula) {
  // At rest, then one count: chord over l, worst j = 1: N̂ = ½(q·(l − 1)/l − ½·L·T²·(l − 1)), l =
  // 2…k̄.
  constexpr double kLimit = 50.0;
  WorstCaseDifference estimator =
      WorstCaseDifference::make({.max_acceleration_mm_s2 = kLimit}).value();
  ASSERT_EQ(estimator.longest_window_ticks(), 4U);  // √(2·N̄/L)/T = 4.47: 4 or 5; 4 is the better
  Estimate e;
  for (int k = 0; k < 20; ++k) {
    e = estimator.tick({k * 0.001, 0, 0.0, 0.001});
  }
  e = estimator.tick({0.020, 1, 0.001, 0.002});
  double shown = 0.0;
  for (int l = 2; l <= 4; ++l) {
    shown = std::max(shown, 0.5 * (0.001 * (l - 1.0) / l - 0.5 * kLimit * 1e-6 * (l - 1.0)));
  }
  const double window = std::min(4.0, std::ceil(2.0 * std::sqrt(shown / kLimit) / 0.001));
  EXPECT_NEAR(e.velocity_mm_s, 0.001 / (window * 0.001), 1e-12);
}

TEST(WorstCaseDifference, ErrsLessThanTheSingleDifference) {
  EXPECT_NEAR(scored<WorstCaseDifference>({.max_acceleration_mm_s2 = 158.0}, sine_ideal())
                  .velocity_rms_mm_s,
              0.226, 0.023);  // first difference 0.428
}

TEST(WorstCaseDifference, RefusesWhatCannotWork) {
  EXPECT_FALSE(WorstCaseDifference::make({.max_acceleration_mm_s2 = 0.0}).has_value());
  EXPECT_FALSE(WorstCaseDifference::make({.max_acceleration_mm_s2 = online::kNoBound}).has_value());
  EXPECT_FALSE(WorstCaseDifference::make({.count_mm = 0.0}).has_value());
  EXPECT_FALSE(WorstCaseDifference::make({.line_error_mm = -1.0}).has_value());
}

}  // namespace
}  // namespace steadyrest::motion::offline::test
