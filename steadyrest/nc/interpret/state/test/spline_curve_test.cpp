// SPDX-License-Identifier: Apache-2.0
#include <array>
#include <cmath>
#include <numbers>
#include <vector>

#include <gtest/gtest.h>

#include <steadyrest/nc/interpret/state/spline_curve.hpp>

namespace steadyrest::nc::interpret {
namespace {

// With as many points as the order there is one span, and the B-spline is the Bézier curve in
// Bernstein's form.
TEST(SplineCurve, OfOneSpanIsTheBezierCurve) {
  const std::array<SplinePoint, 4> points = {SplinePoint{0, 0, 1}, SplinePoint{1, 3, 1},
                                             SplinePoint{4, -2, 1}, SplinePoint{6, 1, 1}};
  EXPECT_EQ(spline_spans(points, 4), 1);
  for (double u = 0.0; u <= 1.0; u += 0.0625) {
    const double v = 1.0 - u;
    const std::array<double, 4> b = {v * v * v, 3 * u * v * v, 3 * u * u * v, u * u * u};
    double x = 0.0;
    double y = 0.0;
    for (std::size_t i = 0; i < 4; ++i) {
      x += b[i] * points[i].x_mm;
      y += b[i] * points[i].y_mm;
    }
    const SplinePoint at = spline_at(points, 4, u);
    EXPECT_NEAR(at.x_mm, x, 1e-14) << u;
    EXPECT_NEAR(at.y_mm, y, 1e-14) << u;
  }
}

// Piegl and Tiller, "The NURBS Book", section 7.3: weights 1, cos 45°, 1 on the corner points make
// an exact quarter circle. No polynomial curve is one.
TEST(SplineCurve, WithWeightsIsAnExactCircle) {
  const std::array<SplinePoint, 3> quarter = {
      SplinePoint{1, 0, 1}, SplinePoint{1, 1, 0.5 * std::numbers::sqrt2}, SplinePoint{0, 1, 1}};
  double unweighted_miss = 0.0;
  std::array<SplinePoint, 3> plain = quarter;
  plain[1].weight = 1.0;
  for (double u = 0.0; u <= 1.0; u += 0.05) {
    const SplinePoint at = spline_at(quarter, 3, u);
    EXPECT_NEAR(std::hypot(at.x_mm, at.y_mm), 1.0, 1e-15) << u;
    const SplinePoint other = spline_at(plain, 3, u);
    unweighted_miss = std::max(unweighted_miss, std::abs(std::hypot(other.x_mm, other.y_mm) - 1.0));
  }
  EXPECT_GT(unweighted_miss, 0.05);
}

// The knots at the ends have full multiplicity, so the ends are control points for every order.
TEST(SplineCurve, BeginsAndEndsOnItsControlPoints) {
  std::vector<SplinePoint> points;
  for (int i = 0; i < 10; ++i) {
    points.push_back({i * 1.5, std::sin(i), 1.0 + 0.25 * i});
  }
  for (int order = 2; order <= 8; ++order) {
    const int spans = spline_spans(points, order);
    EXPECT_EQ(spans, 11 - order);
    const SplinePoint first = spline_at(points, order, 0.0);
    const SplinePoint last = spline_at(points, order, spans);
    EXPECT_NEAR(first.x_mm, 0.0, 1e-14) << order;
    EXPECT_NEAR(first.weight, 1.0, 1e-14) << order;
    EXPECT_NEAR(last.x_mm, 13.5, 1e-12) << order;
    EXPECT_NEAR(last.y_mm, std::sin(9), 1e-12) << order;
  }
}

// Order 2 is the polygon of the control points, span by span.
TEST(SplineCurve, OfOrderTwoIsThePolygon) {
  const std::array<SplinePoint, 4> points = {SplinePoint{0, 0, 1}, SplinePoint{2, 0, 1},
                                             SplinePoint{2, 4, 1}, SplinePoint{-2, 4, 1}};
  EXPECT_EQ(spline_spans(points, 2), 3);
  EXPECT_EQ(spline_at(points, 2, 0.5).x_mm, 1.0);
  EXPECT_EQ(spline_at(points, 2, 1.0).x_mm, 2.0);
  EXPECT_EQ(spline_at(points, 2, 1.25).y_mm, 1.0);
  EXPECT_EQ(spline_at(points, 2, 2.75).x_mm, -1.0);
}

// Points on a line at the Greville abscissae reproduce the line: order 3 on the knots 0 0 0 1 2 2 2
// has them at 0, 0.5, 1.5, 2.
TEST(SplineCurve, ReproducesALineAtTheGrevillePoints) {
  const std::array<SplinePoint, 4> points = {SplinePoint{0, 1, 1}, SplinePoint{0.5, 2, 1},
                                             SplinePoint{1.5, 4, 1}, SplinePoint{2, 5, 1}};
  for (double u = 0.0; u <= 2.0; u += 0.125) {
    EXPECT_NEAR(spline_at(points, 3, u).x_mm, u, 1e-15);
    EXPECT_NEAR(spline_at(points, 3, u).y_mm, 1.0 + 2.0 * u, 1e-14);
  }
}

// A common factor of all weights changes nothing; a heavier point draws the curve to it.
TEST(SplineCurve, OnlyTheRatiosOfWeightsCount) {
  std::vector<SplinePoint> points = {{0, 0, 1}, {1, 2, 2}, {3, 1, 1}, {4, 0, 3}, {6, 2, 1}};
  const SplinePoint before = spline_at(points, 4, 0.7);
  for (SplinePoint& point : points) {
    point.weight *= 7.0;
  }
  const SplinePoint same = spline_at(points, 4, 0.7);
  EXPECT_NEAR(same.x_mm, before.x_mm, 1e-14);
  EXPECT_NEAR(same.y_mm, before.y_mm, 1e-14);
  points[1].weight *= 1000.0;
  const SplinePoint drawn = spline_at(points, 4, 0.7);
  EXPECT_LT(std::hypot(drawn.x_mm - 1.0, drawn.y_mm - 2.0), 0.01);
}

}  // namespace
}  // namespace steadyrest::nc::interpret
