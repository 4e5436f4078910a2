// SPDX-License-Identifier: Apache-2.0
#include <array>
#include <cmath>
#include <numbers>
#include <span>
#include <vector>

#include <gtest/gtest.h>

#include <steadyrest/nc/interpret/state/spline_curve.hpp>
#include <steadyrest/nc/plan/path/spline_lines.hpp>

namespace steadyrest::nc::plan {
namespace {

using interpret::Move;
using interpret::SplinePoint;

// Weight cos 45° in the middle makes the quadratic an exact circle: the curve is known
// independently.
const std::array kQuarterCircle = {SplinePoint{10, 0, 1}, SplinePoint{10, 10, std::sqrt(0.5)},
                                   SplinePoint{0, 10, 1}};

TEST(SplineCurve, AQuarterOfACircleIsARationalQuadratic) {
  for (double u = 0.0; u <= 1.0; u += 0.125) {
    const SplinePoint p = interpret::spline_at(kQuarterCircle, 3, u);
    EXPECT_NEAR(std::hypot(p.x_mm, p.y_mm), 10.0, 1e-12) << u;
  }
}

TEST(SplineCurve, ACubicIsBernsteinsPolynomial) {
  const std::array points = {SplinePoint{0, 0, 1}, SplinePoint{2, 3, 1}, SplinePoint{8, 3, 1},
                             SplinePoint{10, 0, 1}};
  for (double u = 0.0; u <= 1.0; u += 0.1) {
    const double v = 1.0 - u;
    const SplinePoint p = interpret::spline_at(points, 4, u);
    // Σ B_i(u)·P_i with the end points at 0 and 10.
    EXPECT_NEAR(p.x_mm, 3 * v * v * u * 2 + 3 * v * u * u * 8 + u * u * u * 10, 1e-12);
    EXPECT_NEAR(p.y_mm, 3 * v * v * u * 3 + 3 * v * u * u * 3, 1e-12);
  }
}

TEST(SplineCurve, AUniformOneGoesThroughTheMiddlesOfItsInnerLegs) {
  const std::array points = {SplinePoint{0, 0, 1}, SplinePoint{1, 4, 1}, SplinePoint{5, 4, 1},
                             SplinePoint{6, 0, 1}};
  // Two quadratic spans: the knot between them is the middle of the inner control leg, ((1 + 5)/2,
  // 4).
  ASSERT_EQ(interpret::spline_spans(points, 3), 2);
  const SplinePoint p = interpret::spline_at(points, 3, 1.0);
  EXPECT_NEAR(p.x_mm, 3.0, 1e-12);
  EXPECT_NEAR(p.y_mm, 4.0, 1e-12);
}

TEST(SplineLines, StayWithinTheToleranceAndMeet) {
  Move spline;
  spline.kind = interpret::MoveKind::spline;
  spline.start = {10.0, 0.0, 3.0};
  spline.end = {0.0, 10.0, 3.0};
  spline.spline = kQuarterCircle;
  spline.spline_order = 3;
  std::vector<Move> lines;
  spline_lines(spline, 1e-3, [&](const Move& line) { lines.push_back(line); });
  ASSERT_GT(lines.size(), 10U);
  ASSERT_LT(lines.size(), 200U);
  double length = 0.0;
  auto at = spline.start;
  for (const Move& line : lines) {
    EXPECT_EQ(line.kind, interpret::MoveKind::linear);
    EXPECT_EQ(line.start, at);
    at = line.end;
    const double x = 0.5 * (line.start[0] + line.end[0]);
    const double y = 0.5 * (line.start[1] + line.end[1]);
    // A chord is farthest from its arc in the middle.
    EXPECT_LE(10.0 - std::hypot(x, y), 1e-3 + 1e-12);
    length += std::hypot(line.end[0] - line.start[0], line.end[1] - line.start[1]);
  }
  EXPECT_EQ(at, spline.end);
  // The circle's length 10·π/2; the chords are shorter by much less than the bound.
  EXPECT_NEAR(length, 5.0 * std::numbers::pi, 3e-3);
}

}  // namespace
}  // namespace steadyrest::nc::plan
