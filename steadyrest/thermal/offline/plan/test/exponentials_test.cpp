// SPDX-License-Identifier: Apache-2.0
#include <cmath>
#include <random>

#include <gtest/gtest.h>

#include <steadyrest/thermal/offline/plan/exponentials.hpp>

namespace steadyrest::thermal::offline {
namespace {

TEST(Exponentials, OneModeCrossesWhereTheLogarithmSays) {
  // x(t) = 30·(1 − e^(−t/3000)) − 10
  const auto at = sign_changes({{20.0, 0.0}, {-30.0, 1.0 / 3000.0}}, 1e5);
  ASSERT_EQ(at.size(), 1U);
  EXPECT_NEAR(at[0], 3000.0 * std::log(30.0 / 20.0), 1e-9);
}

// (s − ½)(s − ¼) with s = e^(−t/τ): zeros at τ·ln 2 and τ·ln 4, the turn between them.
TEST(Exponentials, TwoCrossingsOfATurningCurveAreBothFound) {
  const double rate = 1e-3;
  const Exponentials f{{0.125, 0.0}, {-0.75, rate}, {1.0, 2.0 * rate}};
  const auto at = sign_changes(f, 1e4);
  ASSERT_EQ(at.size(), 2U);
  EXPECT_NEAR(at[0], std::log(2.0) / rate, 1e-9);
  EXPECT_NEAR(at[1], std::log(4.0) / rate, 1e-9);
  const auto turn = extremes_of(f, 1e4);
  ASSERT_EQ(turn.size(), 1U);
  // 2s = ¾.
  EXPECT_NEAR(turn[0], -std::log(0.375) / rate, 1e-9);
}

TEST(Exponentials, EqualRatesAreOneTerm) {
  const auto at = sign_changes({{20.0, 0.0}, {-10.0, 1e-3}, {-20.0, 1e-3}}, 1e5);
  ASSERT_EQ(at.size(), 1U);
  // 20 − 30·e^(−t/1000).
  EXPECT_NEAR(at[0], 1e3 * std::log(1.5), 1e-9);
}

// Against a dense scan, which is slow and limited by its step.
TEST(Exponentials, NoCrossingOfARandomSumIsMissed) {
  std::mt19937_64 random(7);
  std::uniform_real_distribution<double> amplitude(-30.0, 30.0);
  std::uniform_real_distribution<double> exponent(-5.0, -1.5);
  int crossings = 0;
  for (int run = 0; run < 300; ++run) {
    Exponentials f{{amplitude(random), 0.0}};
    for (int k = 0; k < 4; ++k) {
      f.push_back({amplitude(random), std::pow(10.0, exponent(random))});
    }
    constexpr double kEnd_s = 30000.0;
    const auto at = sign_changes(f, kEnd_s);
    std::size_t seen = 0;
    double before = value(f, 0.0);
    for (double t = 1.0; t <= kEnd_s; t += 1.0) {
      const double now = value(f, t);
      if (before * now < 0.0) {
        ASSERT_LT(seen, at.size()) << "run " << run << ": missed near " << t;
        EXPECT_GE(at[seen], t - 1.0);
        EXPECT_LE(at[seen], t);
        ++seen;
      }
      before = now;
    }
    EXPECT_GE(at.size(), seen);
    EXPECT_LE(at.size(), f.size() - 1) << "a sum of n exponentials has at most n − 1 zeros";
    crossings += static_cast<int>(seen);
  }
  EXPECT_GT(crossings, 150);
}

}  // namespace
}  // namespace steadyrest::thermal::offline
