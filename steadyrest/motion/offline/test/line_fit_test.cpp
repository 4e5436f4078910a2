// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <cmath>
#include <limits>

#include <gtest/gtest.h>

#include <steadyrest/motion/offline/test/scenes.hpp>
#include <steadyrest/motion/online/line/line_fit.hpp>

namespace steadyrest::motion::offline::test {
namespace {

using online::LineFit;

/// When x(t) = 10·t + 3·t² + 2·t³ passes `x_mm`, by Newton.
double time_of(double x_mm) {
  double t = x_mm / 10.0;
  for (int i = 0; i < 30; ++i) {
    t -= (10.0 * t + 3.0 * t * t + 2.0 * t * t * t - x_mm) / (10.0 + 6.0 * t + 6.0 * t * t);
  }
  return t;
}

LineFit::Residual pass(LineFit& fit, int line, double error_mm = 0.0) {
  return fit.push(time_of(line * kCount + error_mm), line * kCount, line, 1);
}

TEST(LineFit, FindsNoErrorWhereTheMotionIsACubic) {
  LineFit fit;
  for (int line = 0; line < 200; ++line) {
    const auto r = pass(fit, line);
    EXPECT_LT(std::abs(r.error_mm), 1e-13) << line;
    EXPECT_LT(r.rms_mm, 1e-9) << line;  // a difference of sums: half of the digits
  }
}

TEST(LineFit, FindsALineThatIsOffByTheClosedFormOfItsOwnWeight) {
  // The middle line has the weight w = 3(3n² − 7)/(4n(n² − 4)) in the cubic through n = 49 even
  // edges (Savitzky and Golay 1964): 1 − w of its error is seen.
  constexpr double kOff = 0.05 * kCount;
  const double n = LineFit::kWindow;
  const double weight = 3.0 * (3.0 * n * n - 7.0) / (4.0 * n * (n * n - 4.0));
  LineFit fit;
  for (int line = 0; line < 130; ++line) {
    const auto r = pass(fit, line, line == 80 ? kOff : 0.0);
    if (r.valid && r.line == 80) {
      EXPECT_NEAR(r.error_mm, kOff * (1.0 - weight), 0.01 * kOff);
      EXPECT_NEAR(r.rms_mm, kOff * std::sqrt((1.0 - weight) / n), 0.01 * kOff);
    }
  }
}

TEST(LineFit, TakesEveryLineOnceUpToItsEndsButTheOutermostSix) {
  LineFit fit;
  int next = static_cast<int>(LineFit::kLeast);
  for (int line = 0; line < 100; ++line) {
    const auto r = pass(fit, line);
    if (r.valid) {
      EXPECT_EQ(r.line, next++);
    }
  }
  EXPECT_EQ(next, 100 - static_cast<int>(LineFit::kHalf));
  for (std::size_t half = fit.longest_tail(); half >= LineFit::kLeast; --half) {
    EXPECT_EQ(fit.tail(half).line, next++);
  }
  EXPECT_EQ(next, 100 - static_cast<int>(LineFit::kLeast));
}

TEST(LineFit, AShortMotionTeachesNoLineTwice) {
  for (int edges = 1; edges < 60; ++edges) {
    LineFit fit;
    int next = static_cast<int>(LineFit::kLeast);
    for (int line = 0; line < edges; ++line) {
      const auto r = pass(fit, line);
      if (r.valid) {
        EXPECT_EQ(r.line, next++) << edges;
      }
    }
    for (std::size_t half = fit.longest_tail(); half >= LineFit::kLeast; --half) {
      const auto r = fit.tail(half);
      EXPECT_TRUE(r.valid) << edges;
      EXPECT_EQ(r.line, next++) << edges;
    }
    EXPECT_EQ(next, std::max(edges, 2 * 6) - 6) << edges;
  }
}

TEST(LineFit, BreaksAtATurnALostEdgeASkippedLineAndTimeThatDoesNotRise) {
  LineFit fit;
  EXPECT_FALSE(fit.breaks(0.0, 5, 1, true));  // nothing is there to break
  (void)fit.push(1.0, 0.005, 5, 1);
  EXPECT_FALSE(fit.breaks(1.1, 6, 1, false));
  EXPECT_TRUE(fit.breaks(1.1, 6, 1, true));
  EXPECT_TRUE(fit.breaks(1.1, 5, -1, false));
  EXPECT_TRUE(fit.breaks(1.1, 7, 1, false));
  EXPECT_TRUE(fit.breaks(1.0, 6, 1, false));
  EXPECT_TRUE(fit.breaks(std::numeric_limits<double>::quiet_NaN(), 6, 1, false));
}

TEST(LineFit, ASlowMotionIsNotUsed) {
  LineFit fit(0.02);
  for (int line = 0; line < 200; ++line) {
    EXPECT_FALSE(fit.push(line * 0.002, line * kCount, line, 1).valid);
  }
}

}  // namespace
}  // namespace steadyrest::motion::offline::test
