// SPDX-License-Identifier: Apache-2.0
#include <cmath>
#include <limits>

#include <gtest/gtest.h>
#include <rapidcheck.h>

#include <steadyrest/contour/offline/closed_form.hpp>

namespace steadyrest::contour::offline {
namespace {

struct Row {
  double feed_mm_min;
  double gain_m_min_mm;
  double contour_mm;
  double tracking_mm;
};

// Simulated circles of R = 10 mm, published to four digits.
constexpr Row kTable[] = {{4000, 1, 0.7152, 3.7139},
                          {4000, 2, 0.1942, 1.9612},
                          {4000, 3, 0.0877, 1.3216},
                          {4000, 5, 0.0319, 0.7975},
                          {2000, 3, 0.0222, 0.6652}};

Servo servo(double gain_1_s, double feed_forward = 0.0, double lag_s = 0.0) {
  return {gain_1_s, feed_forward, lag_s};
}

// k in 1/s is Kv·1000/60 for Kv in (m/min)/mm, the unit of machine data.
TEST(ClosedForm, AgreesWithTheSimulatedCircles) {
  for (const Row& row : kTable) {
    const auto errors =
        circle_errors(servo(row.gain_m_min_mm * 1000.0 / 60.0), 10.0, row.feed_mm_min / 60.0);
    ASSERT_TRUE(errors);
    EXPECT_NEAR(errors->contour_error_mm, row.contour_mm, 6e-5);
    EXPECT_NEAR(errors->tracking_error_mm, row.tracking_mm, 6e-5);
  }
}

TEST(ClosedForm, AgreesWithTheSimulatedFeedForwardAndLag) {
  const auto feed_forward = circle_errors(servo(50, 0.5), 10.0, 4000.0 / 60.0);
  const auto lag = circle_errors(servo(50, 0.0, 0.005), 10.0, 4000.0 / 60.0);
  ASSERT_TRUE(feed_forward);
  ASSERT_TRUE(lag);
  EXPECT_NEAR(feed_forward->contour_error_mm, 0.0656, 1.5e-4);  // simulated to 0.2 %
  EXPECT_NEAR(lag->contour_error_mm, 0.0443, 1.5e-4);
}

// k·τ = 0.75 > ½: ε ≈ (1 − 2kτ)·v²/(2Rk²) < 0.
TEST(ClosedForm, KeepsTheSignWhenTheLagMakesTheCircleTooLarge) {
  const auto errors = circle_errors(servo(50, 0.0, 0.015), 10.0, 4000.0 / 60.0);
  ASSERT_TRUE(errors);
  EXPECT_LT(errors->contour_error_mm, 0.0);
}

// v = R·k·√(1/(1 − ε/R)² − 1): proportional to k, 448 mm/min for each (m/min)/mm.
TEST(ClosedForm, FindsTheFeedsOfTheTable) {
  const double feeds_mm_min[] = {448, 895, 1343, 2238};
  const double gains_m_min_mm[] = {1, 2, 3, 5};
  for (int i = 0; i < 4; ++i) {
    const auto limit = circle_limit(servo(gains_m_min_mm[i] * 1000.0 / 60.0), 10.0, 0.010);
    ASSERT_TRUE(limit);
    EXPECT_NEAR(limit->speed_mm_s * 60.0, feeds_mm_min[i], 0.6);
    EXPECT_NEAR(limit->errors.contour_error_mm, 0.010, 1e-12);
  }
}

// With full feed-forward and no lag |G| = 1 at all speeds.
TEST(ClosedForm, SaysWhenNoSpeedPassesTheLimit) {
  const auto limit = circle_limit(servo(50, 1.0), 10.0, 0.010);
  ASSERT_TRUE(limit);
  EXPECT_TRUE(std::isinf(limit->speed_mm_s));
}

TEST(ClosedForm, RefusesWhatIsNoCircle) {
  const double nan = std::numeric_limits<double>::quiet_NaN();
  EXPECT_FALSE(circle_errors(servo(50), 0.0, 1.0));
  EXPECT_FALSE(circle_errors(servo(50), nan, 1.0));
  EXPECT_FALSE(circle_errors(servo(0), 10.0, 1.0));
  EXPECT_FALSE(circle_errors(servo(50), 10.0, -1.0));
  EXPECT_FALSE(circle_errors(servo(50, 2.0), 10.0, 1.0));
  EXPECT_FALSE(circle_errors(servo(50, 0.0, -0.1), 10.0, 1.0));
  EXPECT_FALSE(circle_limit(servo(50), 10.0, 0.0));
  EXPECT_FALSE(circle_limit(servo(50), 10.0, 10.0));
  EXPECT_FALSE(circle_limit(servo(50), 10.0, nan));
}

Servo any_servo() {
  return servo(*rc::gen::inRange(1, 200), 0.01 * *rc::gen::inRange(0, 121),
               1e-4 * *rc::gen::inRange(0, 300));
}

// R − √(R² − Ed²) holds only for a pure lag; cancellation leaves 10⁻⁹ of R.
TEST(ClosedForm, HoldsTheArcIdentityForAPureLag) {
  rc::check([] {
    const double radius_mm = 0.1 * *rc::gen::inRange(1, 2000);
    const auto errors =
        circle_errors(servo(*rc::gen::inRange(1, 200)), radius_mm, *rc::gen::inRange(1, 500));
    RC_ASSERT(errors.has_value());
    const double ed = errors->tracking_error_mm;
    const double identity = radius_mm - std::sqrt(radius_mm * radius_mm - ed * ed);
    RC_ASSERT(std::abs(errors->contour_error_mm - identity) < 1e-9 * radius_mm + 1e-12);
  });
}

// Below the limit no speed may exceed the error: any root but the smallest would allow it.
TEST(ClosedForm, LimitIsTheFirstSpeedThatPassesTheError) {
  rc::check([] {
    const Servo any = any_servo();
    const double radius_mm = 0.1 * *rc::gen::inRange(10, 2000);
    const double error_mm = 1e-4 * *rc::gen::inRange(1, 5000);
    const auto limit = circle_limit(any, radius_mm, error_mm);
    RC_ASSERT(limit.has_value());
    const double end_mm_s = std::isfinite(limit->speed_mm_s) ? limit->speed_mm_s : 1e5;
    for (int i = 1; i <= 200; ++i) {
      const auto below = circle_errors(any, radius_mm, end_mm_s * i / 200.0);
      RC_ASSERT(std::abs(below->contour_error_mm) <= error_mm * (1.0 + 1e-6));
    }
    if (std::isfinite(limit->speed_mm_s)) {
      RC_ASSERT(std::abs(std::abs(limit->errors.contour_error_mm) - error_mm) < 1e-6 * error_mm);
    }
  });
}

}  // namespace
}  // namespace steadyrest::contour::offline
