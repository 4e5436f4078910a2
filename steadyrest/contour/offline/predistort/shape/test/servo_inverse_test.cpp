// SPDX-License-Identifier: Apache-2.0
#include <cmath>
#include <complex>
#include <numbers>

#include <gtest/gtest.h>
#include <rapidcheck/gtest.h>

#include <steadyrest/contour/offline/predistort/shape/servo_inverse.hpp>
#include <steadyrest/contour/offline/predistort/uncertainty.hpp>
#include <steadyrest/math/geometry/vector.hpp>

namespace steadyrest::contour::offline {
namespace {

namespace geometry = math::geometry;
using kernel::signal::Point;

ServoModels equal(const online::AxisModel& axis) {
  return {axis, axis, axis};
}

/// The top of a circle about the origin, run counter-clockwise.
geometry::Station top_of_circle(double radius_mm) {
  return {.point_mm = {0.0, radius_mm, 0.0},
          .tangent = {-1.0, 0.0, 0.0},
          .curvature_1_mm = {0.0, -1.0 / radius_mm, 0.0}};
}

// Truth: on a circle the command is the tool's point turned and scaled by 1/G(jω).
RC_GTEST_PROP(ServoInverse, OnACircleIsTheInverseTransferFunction, ()) {
  const double k = 20.0 + 0.1 * *rc::gen::inRange(0, 600);
  const double lag = 0.0005 * *rc::gen::inRange(0, 10);
  const double radius = 2.0 + 0.1 * *rc::gen::inRange(0, 300);
  const double v = std::min(60.0, 0.3 * k * radius);
  const double w = v / radius;
  const ServoInverse inverse(equal({.gain_1_s = k, .velocity_lag_s = lag}));
  const Point command = inverse.command_mm(top_of_circle(radius), v, 0.0);
  const std::complex<double> jw(0.0, w);
  const std::complex<double> wanted =
      std::complex<double>(0.0, radius) * (1.0 + jw / k + lag * jw * jw / k);
  RC_ASSERT(std::abs(command[0] - wanted.real()) < 1e-9);
  RC_ASSERT(std::abs(command[1] - wanted.imag()) < 1e-9);
}

// With feed-forward the series ends after the second order: what is left is of the third.
TEST(ServoInverse, WithFeedForwardIsGoodToTheSecondOrder) {
  const online::AxisModel axis{.gain_1_s = 50.0, .feed_forward = 0.7, .velocity_lag_s = 0.002};
  const ServoInverse inverse(equal(axis));
  const double radius = 10.0;
  for (const double v : {10.0, 20.0, 40.0}) {
    const std::complex<double> jw(0.0, v / radius);
    const std::complex<double> exact =
        std::complex<double>(0.0, radius) *
        (1.0 + jw / axis.gain_1_s + axis.velocity_lag_s * jw * jw / axis.gain_1_s) /
        (1.0 + axis.feed_forward * jw / axis.gain_1_s);
    const Point command = inverse.command_mm(top_of_circle(radius), v, 0.0);
    const double off = std::abs(std::complex<double>(command[0], command[1]) - exact);
    EXPECT_LT(off, radius * std::pow(v / radius / axis.gain_1_s, 3));
  }
}

TEST(ServoInverse, LeadsAlongStraightLinesAlone) {
  const ServoInverse inverse(equal({.gain_1_s = 50.0}));
  const geometry::Station line = {
      .point_mm = {1.0, 2.0, 3.0}, .tangent = {0.6, 0.8, 0.0}, .curvature_1_mm = {}};
  EXPECT_LT(geometry::distance(inverse.command_mm(line, 25.0, 1000.0), {1.3, 2.4, 3.0}), 1e-12);
  EXPECT_DOUBLE_EQ(inverse.lag_s(), 0.02);
}

// The command's speed is the derivative of its place.
RC_GTEST_PROP(ServoInverse, FindsTheToolsAccelerationFromTheCommandsSpeed, ()) {
  const double radius = 1.0 + 0.1 * *rc::gen::inRange(0, 200);
  const double v = 5.0 + *rc::gen::inRange(0, 50);
  // Beyond −k·v the command goes backwards, and there are two answers.
  const double a = 0.01 * v * *rc::gen::inRange(-3500, 6000);
  const ServoModels models = {online::AxisModel{.gain_1_s = 40.0},
                              online::AxisModel{.gain_1_s = 55.0},
                              online::AxisModel{.gain_1_s = 50.0}};
  const ServoInverse inverse(models);
  // Along the circle at v + a·t: where the command is a moment before and after.
  const auto command_at = [&](double t) {
    const double s = v * t + 0.5 * a * t * t;
    const double angle = std::numbers::pi / 2.0 + s / radius;
    const geometry::Station at = {
        .point_mm = {radius * std::cos(angle), radius * std::sin(angle), 0.0},
        .tangent = {-std::sin(angle), std::cos(angle), 0.0},
        .curvature_1_mm = {-std::cos(angle) / radius, -std::sin(angle) / radius, 0.0}};
    return inverse.command_mm(at, v + a * t, a);
  };
  constexpr double kMoment_s = 1e-5;
  const Point velocity = geometry::scale(
      geometry::subtract(command_at(kMoment_s), command_at(-kMoment_s)), 0.5 / kMoment_s);
  const double speed = geometry::norm(velocity);
  const double found = inverse.acceleration_mm_s2(top_of_circle(radius), v, speed);
  RC_ASSERT(std::abs(found - a) < 1.0 + 1e-3 * std::abs(a));
  RC_ASSERT(geometry::distance(inverse.direction(top_of_circle(radius), v, a),
                               geometry::unit(velocity)) < 1e-3);
}

TEST(ServoInverse, AddsHalfOfTheBacklashInTheDirectionOfTravel) {
  const ServoInverse inverse(equal({.gain_1_s = 50.0}), {0.010, 0.006, 0.0});
  const Point command = inverse.command_mm(top_of_circle(10.0), 10.0, 0.0);
  EXPECT_NEAR(command[0], -0.2 - 0.005, 1e-9);
  // Y is at its turning point.
  EXPECT_NEAR(command[1], 10.0, 1e-9);
}

TEST(Uncertainty, TakesGainsAsEqualAsTheyMayBe) {
  ServoModels models = equal({.gain_1_s = 50.0});
  models[1].gain_1_s = 52.0;
  const ServoModels close = cautious(models, 0.05);
  EXPECT_DOUBLE_EQ(close[0].gain_1_s, close[1].gain_1_s);
  EXPECT_GE(close[0].gain_1_s, 52.0 * 0.95);
  EXPECT_LE(close[0].gain_1_s, 50.0 * 1.05);
  // Further apart than that, each goes as far as it may.
  models[1].gain_1_s = 80.0;
  const ServoModels far = cautious(models, 0.05);
  EXPECT_DOUBLE_EQ(far[0].gain_1_s, 52.5);
  EXPECT_DOUBLE_EQ(far[1].gain_1_s, 76.0);
  EXPECT_EQ(cautious(models, 0.0)[1].gain_1_s, 80.0);
}

}  // namespace
}  // namespace steadyrest::contour::offline
