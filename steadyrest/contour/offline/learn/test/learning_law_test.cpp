// SPDX-License-Identifier: Apache-2.0
// The law of learning against closed forms: the factor by which an unknown error shrinks, and the
// local fit that is low-pass and lead in one.
#include <algorithm>
#include <cmath>
#include <numbers>
#include <vector>

#include <gtest/gtest.h>

#include <steadyrest/contour/offline/learn/convergence.hpp>
#include <steadyrest/contour/offline/learn/local_fit.hpp>

namespace steadyrest::contour::offline {
namespace {

using kernel::signal::Point;

constexpr double kVeryShort_s = 1e-9;  // 0 would mean the usual 0.2/k

ServoModels servos(double gain_1_s) {
  const online::AxisModel axis{.gain_1_s = gain_1_s};
  return {axis, axis, axis};
}

double low_pass(double omega_1_s, double sigma_s) {
  return std::exp(-0.5 * omega_1_s * omega_1_s * sigma_s * sigma_s);
}

/// The largest value of a law of ω.
template <class Law>
double largest(Law law, double end_1_s) {
  double most = 0.0;
  for (double omega = 0.1; omega < end_1_s; omega *= 1.01) {
    most = std::max(most, law(omega));
  }
  return most;
}

TEST(LearningLaw, WidthGivesHalfThePowerAtTheCutOff) {
  for (const double hz : {2.0, 16.0, 40.0}) {
    EXPECT_NEAR(low_pass(2.0 * std::numbers::pi * hz, width_s(hz)), std::numbers::sqrt2 / 2.0,
                1e-12);
  }
}

// 1 − G/Ĝ = s·(k − k′)/(k·(s + k′)) with only the gain unknown; the softer axis is the worse one.
TEST(LearningLaw, AnUnknownGainShrinksByTheClosedForm) {
  for (const double share : {0.05, 0.2, 0.5}) {
    const double k = 50.0;
    const double softer = k * (1.0 - share);
    const double sigma = width_s(16.0);
    const double expected = largest(
        [&](double omega) {
          return low_pass(omega, sigma) * omega * share / std::hypot(omega, softer);
        },
        1e3);
    const double found = convergence(
        servos(k), {.gain_share = share, .velocity_lag_s = kVeryShort_s, .feed_forward = 0.0},
        16.0);
    EXPECT_NEAR(found, expected, 0.005 * expected) << share;
    EXPECT_LT(found, share);
  }
}

// 1 − G/Ĝ = τs²/(τs² + s + k) with only a velocity lag unknown.
TEST(LearningLaw, AnUnknownLagShrinksByTheClosedForm) {
  const double k = 50.0;
  for (const double lags : {0.1, 0.3, 0.5}) {
    const double tau = lags / k;
    const double sigma = width_s(30.0);
    const double expected = largest(
        [&](double omega) {
          return low_pass(omega, sigma) * tau * omega * omega /
                 std::hypot(k - tau * omega * omega, omega);
        },
        1e3);
    const double found = convergence(
        servos(k), {.gain_share = 0.0, .velocity_lag_s = tau, .feed_forward = 0.0}, 30.0);
    EXPECT_NEAR(found, expected, 0.005 * expected) << lags;
    EXPECT_LT(found, 1.0) << lags;
  }
}

// An unknown feed-forward a gives a·ω/k, which grows without bound: only the cut-off bounds it.
TEST(LearningLaw, TooHighACutOffDoesNotConverge) {
  const Uncertainty feed_forward{
      .gain_share = 0.0, .velocity_lag_s = kVeryShort_s, .feed_forward = 0.2};
  EXPECT_LT(convergence(servos(50.0), feed_forward, 10.0), 0.5);
  EXPECT_GT(convergence(servos(50.0), feed_forward, 200.0), 1.0);
}

TEST(LearningLaw, ConvergesAtTheUsualCutOffWhateverTheGain) {
  for (const double k : {8.0, 20.0, 50.0, 120.0}) {
    const double factor = convergence(servos(k), {}, 2.0 * k / (2.0 * std::numbers::pi));
    EXPECT_LT(factor, 0.5) << k;
    EXPECT_GT(factor, 0.3) << k;
  }
}

// A softer axis among stiff ones decides.
TEST(LearningLaw, TheWorstAxisCounts) {
  ServoModels mixed = servos(50.0);
  mixed[1].gain_1_s = 10.0;
  EXPECT_DOUBLE_EQ(convergence(mixed, {}, 10.0), convergence(servos(10.0), {}, 10.0));
}

std::vector<double> clock(std::size_t count, double period_s) {
  std::vector<double> time;
  for (std::size_t i = 0; i < count; ++i) {
    time.push_back(static_cast<double>(i) * period_s);
  }
  return time;
}

TEST(LocalLine, IsExactForStraightLinesUpToTheEnds) {
  const auto time = clock(60, 0.004);
  std::vector<Point> value;
  for (const double t_s : time) {
    value.push_back({0.003 - 0.2 * t_s, 0.05 * t_s, 0.001});
  }
  for (const std::size_t j : {0U, 1U, 30U, 58U, 59U}) {
    const LocalLine line = local_line(time, value, j, 0.02);
    for (std::size_t axis = 0; axis < 3; ++axis) {
      EXPECT_NEAR(line.value[axis], value[j][axis], 1e-12);
    }
    EXPECT_NEAR(line.slope_1_s[0], -0.2, 1e-9);
    EXPECT_NEAR(line.slope_1_s[1], 0.05, 1e-9);
    EXPECT_NEAR(line.slope_1_s[2], 0.0, 1e-9);
  }
}

// cos ωt in, Q·cos ωt out, no phase; its slope is that of the low-passed wave.
TEST(LocalLine, HasTheGaussianResponseInside) {
  const double period = 0.002;
  const double sigma = 0.01;
  const auto time = clock(400, period);
  for (const double omega : {20.0, 80.0, 160.0}) {
    std::vector<Point> value;
    for (const double t_s : time) {
      value.push_back({std::cos(omega * t_s), std::sin(omega * t_s), 0.0});
    }
    for (const std::size_t j : {150U, 200U, 233U}) {
      const double q = low_pass(omega, sigma);
      const LocalLine line = local_line(time, value, j, sigma);
      EXPECT_NEAR(line.value[0], q * std::cos(omega * time[j]), 2e-3) << omega;
      EXPECT_NEAR(line.value[1], q * std::sin(omega * time[j]), 2e-3) << omega;
      EXPECT_NEAR(line.slope_1_s[1], q * omega * std::cos(omega * time[j]), 2e-3 * omega);
    }
  }
}

TEST(LocalLine, ASingleSampleHasNoSlope) {
  const std::vector<double> time = {1.0};
  const std::vector<Point> value = {{0.001, -0.002, 0.003}};
  const LocalLine line = local_line(time, value, 0, 0.01);
  EXPECT_EQ(line.value, value.front());
  EXPECT_EQ(line.slope_1_s, Point{});
}

}  // namespace
}  // namespace steadyrest::contour::offline
