// SPDX-License-Identifier: Apache-2.0
#include <cmath>
#include <random>

#include <gtest/gtest.h>

#include <steadyrest/motion/online/bounded/cell_sight.hpp>
#include <steadyrest/motion/online/bounded/model_bank.hpp>

namespace steadyrest::motion::online {
namespace {

using Matrix = std::array<std::array<double, 3>, 3>;

Matrix full(const Moments& m) {
  const auto& c = m.covariance;
  return {{{c[0], c[1], c[2]}, {c[1], c[3], c[4]}, {c[2], c[4], c[5]}}};
}

ModelBank with(const Moments& moments) {
  ModelBank bank;
  for (std::size_t j = 0; j < kModels; ++j) {
    bank.set(j, moments);
  }
  return bank;
}

const Moments kSome{{1.5, -20.0, 300.0}, {4.0, 3.0, 10.0, 90.0, 120.0, 5000.0}};

// Q = S·[dt⁵/20 dt⁴/8 dt³/6; dt⁴/8 dt³/3 dt²/2; dt³/6 dt²/2 dt].
TEST(ModelBank, PredictsAsTheClosedFormOfWhiteJerk) {
  ModelBank bank = with(kSome);
  const double d = 0.02;
  const double s = 7e4;
  bank.predict(d, all(s), all(0.0));
  // P' = Φ P Φᵀ + Q, written out.
  const Matrix p = full(kSome);
  const Matrix phi{{{1, d, d * d / 2}, {0, 1, d}, {0, 0, 1}}};
  const Matrix q{{{std::pow(d, 5) / 20, std::pow(d, 4) / 8, std::pow(d, 3) / 6},
                  {std::pow(d, 4) / 8, std::pow(d, 3) / 3, d * d / 2},
                  {std::pow(d, 3) / 6, d * d / 2, d}}};
  const Matrix found = full(bank.moments(2));
  for (std::size_t i = 0; i < 3; ++i) {
    for (std::size_t j = 0; j < 3; ++j) {
      double expected = s * q[i][j];
      for (std::size_t k = 0; k < 3; ++k) {
        for (std::size_t m = 0; m < 3; ++m) {
          expected += phi[i][k] * p[k][m] * phi[j][m];
        }
      }
      EXPECT_NEAR(found[i][j], expected, 1e-10 * std::abs(expected) + 1e-12) << i << j;
    }
  }
  EXPECT_NEAR(bank.x[0], 1.5 - 20.0 * d + 150.0 * d * d, 1e-12);
  EXPECT_NEAR(bank.v[3], -20.0 + 300.0 * d, 1e-12);
}

// The plain form P − K·H·P is the oracle: another algorithm for the same numbers.
TEST(ModelBank, UpdatesAsThePlainKalmanFilter) {
  ModelBank bank = with(kSome);
  const double z = 2.0;
  const double r = 0.5;
  bank.update(all(z), all(r));
  const Matrix p = full(kSome);
  const double total = p[0][0] + r;
  const Moments found = bank.moments(1);
  for (std::size_t i = 0; i < 3; ++i) {
    EXPECT_NEAR(found.mean[i], kSome.mean[i] + p[i][0] / total * (z - kSome.mean[0]), 1e-10);
    for (std::size_t j = 0; j < 3; ++j) {
      EXPECT_NEAR(full(found)[i][j], p[i][j] - p[i][0] * p[0][j] / total, 1e-8);
    }
  }
}

// Mixing expands and factors each model again and again: that must not cause drift.
TEST(ModelBank, MomentsGoInAndOutUnchanged) {
  const ModelBank bank = with(kSome);
  for (std::size_t i = 0; i < 6; ++i) {
    EXPECT_NEAR(bank.moments(0).covariance[i], kSome.covariance[i], 1e-9);
  }
}

// Here rounding costs the plain form its positive definiteness; the factored one must keep it.
TEST(ModelBank, StaysPositiveThroughAMillionSharpMeasurements) {
  ModelBank bank = with(kSome);
  std::mt19937 random(1);
  std::uniform_real_distribution<double> gap(1e-7, 1e-3);
  double t = 0.0;
  for (int i = 0; i < 1'000'000; ++i) {
    t += gap(random);
    bank.predict(t, {1e2, 1e6, 1e10, 1e14}, {0.0, 6.0, 0.0, 1900.0});
    bank.update(all(1.0), all(1e-10));
    for (std::size_t j = 0; j < kModels; ++j) {
      ASSERT_GT(bank.d1[j], 0.0);
      ASSERT_GT(bank.d2[j], 0.0);
      ASSERT_GT(bank.d3[j], 0.0);
    }
  }
}

/// Mean and variance of N(0, 1) cut to [a, b] by summation.
std::array<double, 3> cut_normal(double a, double b) {
  double mass = 0.0;
  double first = 0.0;
  double second = 0.0;
  constexpr int kSteps = 200000;
  const double low = std::max(a, -12.0);
  const double high = std::min(b, 12.0);
  const double h = (high - low) / kSteps;
  for (int i = 0; i < kSteps; ++i) {
    const double z = low + (i + 0.5) * h;
    const double w = std::exp(-0.5 * z * z) * h / std::sqrt(2.0 * 3.14159265358979323846);
    mass += w;
    first += w * z;
    second += w * z * z;
  }
  const double mean = first / mass;
  return {mass, mean, second / mass - mean * mean};
}

TEST(ModelBank, TheCellGivesTheMomentsOfTheTruncatedNormal) {
  const std::array<std::array<double, 2>, 8> cells{{{-1.0, 0.5},
                                                    {-6.0, 0.0},
                                                    {0.5, 9.0},
                                                    {-8.0, -2.5},
                                                    {2.0, 2.5},
                                                    {-0.01, 0.01},
                                                    {-4.0, 4.0},
                                                    {3.5, 4.5}}};
  for (const auto& cell : cells) {
    const auto [mass, mean, variance] = cut_normal(cell[0], cell[1]);
    ModelBank bank = with({{10.0, 0.0, 0.0}, {4.0, 0.0, 0.0, 1.0, 0.0, 1.0}});  // σ = 2
    const Lanes share = truncate(bank, 10.0 + 2.0 * cell[0], 10.0 + 2.0 * cell[1]);
    EXPECT_NEAR(share[0], mass, 1e-6 * mass + 1e-7) << cell[0] << " " << cell[1];
    EXPECT_NEAR(bank.x[0], 10.0 + 2.0 * mean, 2e-4) << cell[0] << " " << cell[1];
    EXPECT_NEAR(bank.position_variance()[0], 4.0 * variance, 0.002 * 4.0 * variance + 1e-6)
        << cell[0] << " " << cell[1];
  }
}

TEST(Lanes, TheExponentialsAreWithinTheirStatedErrors) {
  for (double y = 0.0; y <= 4.0; y += 0.01) {
    EXPECT_NEAR(exp_of_minus(y), std::exp(-y), 1e-5);
  }
  for (double x = -450.0; x <= 450.0; x += 0.37) {
    EXPECT_NEAR(fast_exp(x) / std::exp(x), 1.0, 2e-8) << x;
  }
  for (double z = 0.0; z < 30.0; z += 0.05) {
    EXPECT_NEAR(upper_tail(z).share / (0.5 * std::erfc(z / std::sqrt(2.0))), 1.0, 3e-7) << z;
  }
}

}  // namespace
}  // namespace steadyrest::motion::online
