// SPDX-License-Identifier: Apache-2.0
#include <cmath>
#include <vector>

#include <gtest/gtest.h>

#include <steadyrest/sim/base/noise.hpp>

namespace steadyrest::sim {
namespace {

// Tolerances are five standard errors at n = 10⁶: 1/√n of the mean, √2/√n of the variance, √96/√n
// of the fourth moment, √(p(1 − p)/n) of the share beyond 2σ, p = 0.0455.
TEST(NormalNoise, HasTheMomentsAndTailsOfTheNormalLaw) {
  NormalNoise noise(7);
  const int n = 1000000;
  double sum = 0.0;
  double sum2 = 0.0;
  double sum4 = 0.0;
  int beyond2 = 0;
  for (int i = 0; i < n; ++i) {
    const double x = noise.next();
    sum += x;
    sum2 += x * x;
    sum4 += x * x * x * x;
    beyond2 += std::abs(x) > 2.0 ? 1 : 0;
  }
  EXPECT_NEAR(sum / n, 0.0, 5e-3);
  EXPECT_NEAR(sum2 / n, 1.0, 7e-3);
  EXPECT_NEAR(sum4 / n, 3.0, 5e-2);
  EXPECT_NEAR(static_cast<double>(beyond2) / n, 0.0455, 1e-3);
}

TEST(NormalNoise, SameSeedSameNumbersOtherSeedOthers) {
  NormalNoise a(42);
  NormalNoise b(42);
  NormalNoise c(43);
  int different = 0;
  for (int i = 0; i < 1000; ++i) {
    const double x = a.next();
    EXPECT_EQ(x, b.next());
    different += x != c.next() ? 1 : 0;
  }
  EXPECT_EQ(different, 1000);
}

// First-order process: after one correlation time (five steps of 1 ms) the correlation is 1/e.
TEST(ColouredNoise, HasItsRmsAndCorrelationTime) {
  NormalNoise normal(3);
  ColouredNoise noise(0.002, 0.001, 0.005);
  const int n = 400000;
  std::vector<double> x(n);
  double sum2 = 0.0;
  for (double& value : x) {
    value = noise.update(normal.next());
    sum2 += value * value;
  }
  EXPECT_NEAR(std::sqrt(sum2 / n), 0.002, 0.002 * 0.02);
  double lagged = 0.0;
  for (int i = 5; i < n; ++i) {
    lagged += x[static_cast<std::size_t>(i)] * x[static_cast<std::size_t>(i - 5)];
  }
  EXPECT_NEAR(lagged / sum2, std::exp(-1.0), 0.03);
}

}  // namespace
}  // namespace steadyrest::sim
