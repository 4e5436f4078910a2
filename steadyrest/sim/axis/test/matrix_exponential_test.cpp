// SPDX-License-Identifier: Apache-2.0
#include <cmath>
#include <limits>
#include <numbers>

#include <gtest/gtest.h>

#include <steadyrest/sim/axis/matrix_exponential.hpp>

namespace steadyrest::sim {
namespace {

/// Each squaring doubles the rounding so far, and a matrix of this norm is squared log₂(4·norm)
/// times: the relative error is a few ε·norm.
double rounding(double norm) {
  return (4.0 * norm + 2.0) * std::numeric_limits<double>::epsilon();
}

void expect_near(const Matrix2& is, const Matrix2& wanted, double tolerance) {
  EXPECT_NEAR(is.xx, wanted.xx, tolerance);
  EXPECT_NEAR(is.xv, wanted.xv, tolerance);
  EXPECT_NEAR(is.vx, wanted.vx, tolerance);
  EXPECT_NEAR(is.vv, wanted.vv, tolerance);
}

TEST(MatrixExponential, OfNoTimeIsTheIdentity) {
  expect_near(exponential({0, 0, 0, 0}), {1, 0, 0, 1}, 0.0);
}

// x′ = v, v′ = 0: free motion, exact since the matrix is nilpotent.
TEST(MatrixExponential, OfFreeMotionIsVelocityTimesTime) {
  expect_near(exponential({0, 0.001, 0, 0}), {1, 0.001, 0, 1}, 0.0);
  expect_near(exponential({0, 1000, 0, 0}), {1, 1000, 0, 1}, 1e-12);
}

TEST(MatrixExponential, OfUncoupledDecayIsTheExponential) {
  for (const double rate : {1e-6, 0.1, 1.0, 5.0, 30.0}) {
    expect_near(exponential({-rate, 0, 0, 0.5 * rate}),
                {std::exp(-rate), 0, 0, std::exp(0.5 * rate)},
                rounding(1.5 * rate) * std::exp(0.5 * rate));
  }
}

// A rotation by φ; at many turns squaring has multiplied its rounding.
TEST(MatrixExponential, OfAnUndampedOscillatorIsARotation) {
  for (const double angle : {0.01, 1.0, std::numbers::pi, 100.0}) {
    expect_near(exponential({0, angle, -angle, 0}),
                {std::cos(angle), std::sin(angle), -std::sin(angle), std::cos(angle)},
                1e-15 * (4.0 + angle));
  }
}

// Mode of ω = 2π·922 rad/s, ζ = 0.011 over 0.1 ms, by the textbook's closed form.
TEST(MatrixExponential, OfADampedModeIsTheTextbooksResponse) {
  constexpr double kOmega = 2.0 * std::numbers::pi * 922.0;
  constexpr double kZeta = 0.011;
  constexpr double kStep_s = 1e-4;
  const double damped = kOmega * std::sqrt(1.0 - kZeta * kZeta);
  const double decay = std::exp(-kZeta * kOmega * kStep_s);
  const double c = std::cos(damped * kStep_s);
  const double s = std::sin(damped * kStep_s);
  const Matrix2 step =
      exponential({0, kStep_s, -kOmega * kOmega * kStep_s, -2.0 * kZeta * kOmega * kStep_s});
  const double relative = rounding(kOmega * kOmega * kStep_s);  // 3·10⁻¹²
  EXPECT_NEAR(step.xx, decay * (c + kZeta * kOmega / damped * s), relative);
  EXPECT_NEAR(step.xv, decay * s / damped, relative / damped);
  EXPECT_NEAR(step.vx, -decay * kOmega * kOmega / damped * s, relative * kOmega);
  EXPECT_NEAR(step.vv, decay * (c - kZeta * kOmega / damped * s), relative);
}

// Equal roots have no two eigenvectors, where a solution by eigenvalues divides by zero: e^at·(1 +
// …·t) must come out all the same.
TEST(MatrixExponential, OfEqualRootsNeedsNoSpecialCase) {
  // Critically damped, ω = 2: [[0, 1], [−4, −4]]·h.
  constexpr double kStep_s = 0.7;
  const double decay = std::exp(-2.0 * kStep_s);
  expect_near(exponential({0, kStep_s, -4.0 * kStep_s, -4.0 * kStep_s}),
              {decay * (1.0 + 2.0 * kStep_s), decay * kStep_s, -4.0 * decay * kStep_s,
               decay * (1.0 - 2.0 * kStep_s)},
              rounding(9.0 * kStep_s));
}

// Two half steps are one step, and back is where it began: det e^A = e^trace A.
TEST(MatrixExponential, KeepsTheGroupsLaws) {
  const Matrix2 a{-3.0, 7.0, -2.0, 0.5};
  const Matrix2 half = exponential({a.xx / 2, a.xv / 2, a.vx / 2, a.vv / 2});
  const Matrix2 whole = exponential(a);
  expect_near({half.xx * half.xx + half.xv * half.vx, half.xx * half.xv + half.xv * half.vv,
               half.vx * half.xx + half.vv * half.vx, half.vx * half.xv + half.vv * half.vv},
              whole, 1e-14);
  EXPECT_NEAR(whole.xx * whole.vv - whole.xv * whole.vx, std::exp(a.xx + a.vv), 1e-14);
}

// A matrix of infinities must not hang the machine.
TEST(MatrixExponential, EndsWhateverItIsGiven) {
  const double inf = HUGE_VAL;
  EXPECT_FALSE(std::isfinite(exponential({inf, 0, 0, inf}).xx));
  EXPECT_TRUE(std::isnan(exponential({std::nan(""), 0, 0, 0}).xx));
}

}  // namespace
}  // namespace steadyrest::sim
