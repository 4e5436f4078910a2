// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <cmath>
#include <numbers>

#include <gtest/gtest.h>
#include <rapidcheck/gtest.h>

#include <steadyrest/math/geometry/foot_point.hpp>
#include <steadyrest/math/geometry/segment.hpp>
#include <steadyrest/math/geometry/test/segments.hpp>
#include <steadyrest/math/geometry/vector.hpp>

namespace steadyrest::math::geometry {
namespace {

using kernel::signal::PathSegment;

/// Dense sampling, then golden-section search around the best sample: slow, but needs no
/// derivative.
double brute_distance(const PathSegment& segment, const Point& query, double low, double high) {
  const auto at = [&](double u) { return distance(point_at(segment, u), query); };
  const int count = 4000;
  int best = 0;
  for (int i = 1; i <= count; ++i) {
    if (at(low + (high - low) * i / count) < at(low + (high - low) * best / count)) {
      best = i;
    }
  }
  double a = low + (high - low) * std::max(0, best - 1) / count;
  double b = low + (high - low) * std::min(count, best + 1) / count;
  const double golden = (std::sqrt(5.0) - 1.0) / 2.0;
  for (int i = 0; i < 80; ++i) {
    const double c = b - golden * (b - a);
    const double d = a + golden * (b - a);
    (at(c) < at(d) ? b : a) = at(c) < at(d) ? d : c;
  }
  return std::min({at(0.5 * (a + b)), at(low), at(high)});
}

// The oracle uses only distances, so a wrong derivative shows.
RC_GTEST_PROP(FootPoint, OfLinesIsWithinANanometreOfDenseSampling, ()) {
  const PathSegment segment = test::line(*test::point(50.0), *test::point(50.0));
  const Point query = *test::point(80.0);
  const Foot foot = foot_point(segment, query);
  RC_ASSERT(std::abs(foot.distance_mm - brute_distance(segment, query, 0.0, 1.0)) <= 1e-9);
  RC_ASSERT(distance(foot.point_mm, point_at(segment, foot.u)) <= 1e-9);
}

// Queries up to 0.9 radii off: near the axis the foot jumps from one side to the other.
RC_GTEST_PROP(FootPoint, OfArcsHelicesAndSpiralsMatchesDenseSamplingWithinTwoTurns, ()) {
  const PathSegment segment = *test::any_arc();
  const double reach = std::min(1.0, 6.2 / segment.sweep_rad);
  const double low = *test::number(0.0, 1.0) * (1.0 - reach);
  const double high = low + reach * *test::number(0.05, 1.0);
  const double u = low + (high - low) * *test::number(0.0, 1.0);
  const Point query = add(point_at(segment, u), *test::point(0.9 * segment.radius_mm));
  const Foot foot = foot_point(segment, query, low, high, u);
  const double truth = brute_distance(segment, query, low, high);
  RC_ASSERT(foot.u >= low && foot.u <= high);
  RC_ASSERT(std::abs(foot.distance_mm - truth) <= 1e-9);
  RC_ASSERT(distance(foot.point_mm, point_at(segment, foot.u)) <= 1e-9);
}

// As a text with rounded digits has them: another radius at the end, less than a turn.
RC_GTEST_PROP(FootPoint, OfArcsWithRoundedRadiiMatchesDenseSampling, ()) {
  PathSegment segment = *test::any_arc();
  segment = test::arc(segment.centre_mm, segment.axis, segment.radius_mm,
                      segment.radius_mm * (1.0 + *test::number(-1e-3, 1e-3)), 0.0,
                      *test::number(0.01, 6.2), 0.0);
  const double reach = std::min(1.0, 5.6 / segment.sweep_rad);
  const double low = *test::number(0.0, 1.0) * (1.0 - reach);
  const double high = low + reach * *test::number(0.05, 1.0);
  const double u = *test::number(0.0, 1.0);
  const Point query = add(point_at(segment, u), *test::point(2.0 * segment.radius_mm));
  const Foot foot = foot_point(segment, query, low, high, 0.5 * (low + high));
  RC_ASSERT(foot.u >= low && foot.u <= high);
  RC_ASSERT(std::abs(foot.distance_mm - brute_distance(segment, query, low, high)) <= 1e-9);
  RC_ASSERT(distance(foot.point_mm, point_at(segment, foot.u)) <= 1e-9);
}

// Four turns coincide; only u_near can tell them apart.
TEST(FootPoint, OnAMultiTurnCircleStaysOnTheTurnThatIsAsked) {
  const double turn = 2.0 * std::numbers::pi;
  const PathSegment circle = test::arc({}, {0, 0, 1}, 10.0, 10.0, 0.0, 4.0 * turn, 0.0);
  for (const double turns : {0.3, 1.3, 2.3, 3.3}) {
    const double u = turns / 4.0;
    const Point query = scale(point_at(circle, u), 0.99);
    const Foot foot = foot_point(circle, query, 0.0, 1.0, u + 0.01);
    EXPECT_NEAR(foot.u, u, 1e-12);
    EXPECT_NEAR(foot.distance_mm, 0.1, 1e-12);
  }
}

TEST(FootPoint, OnAHelixDoesNotLeaveTheTurnNearestToTheQuery) {
  const double turn = 2.0 * std::numbers::pi;
  const PathSegment helix =
      test::arc({}, {0, 0, 1}, 5.0, 5.0, 0.0, 8.0 * turn, 4.0);  // 0.5 mm/turn
  const Point query = add(point_at(helix, 0.51), Point{0.0, 0.0, 0.02});
  EXPECT_NEAR(foot_point(helix, query, 0.0, 1.0, 0.5).u, 0.51, 1e-3);
}

TEST(FootPoint, OfACentreIsAtTheRadius) {
  const PathSegment circle = test::arc({1, 2, 3}, {0, 0, 1}, 7.0, 7.0, 0.0, 6.0, 0.0);
  EXPECT_NEAR(foot_point(circle, {1, 2, 3}, 0.2, 0.8, 0.5).distance_mm, 7.0, 1e-12);
}

}  // namespace
}  // namespace steadyrest::math::geometry
