// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <cmath>
#include <numbers>

#include <gtest/gtest.h>
#include <rapidcheck/gtest.h>

#include <steadyrest/math/geometry/segment.hpp>
#include <steadyrest/math/geometry/test/segments.hpp>
#include <steadyrest/math/geometry/vector.hpp>

namespace steadyrest::math::geometry {
namespace {

using kernel::signal::PathSegment;

// Unrolled, a helix is the hypotenuse of r·ω and its rise.
TEST(Segment, LengthOfAHelixIsItsUnrolledHypotenuse) {
  const PathSegment helix = test::arc({}, {0, 0, 1}, 10.0, 10.0, 0.3, 3.0, 2.0);
  EXPECT_NEAR(arc_length_mm(helix), std::hypot(30.0, 2.0), 1e-12);
}

TEST(Segment, LengthOfAnArchimedeanSpiralIsTheTextbookIntegral) {
  // r = b·θ from the centre over one turn: b/2·(θ√(1+θ²) + asinh θ)
  const double turn = 2.0 * std::numbers::pi;
  const double b = 0.5;
  const PathSegment spiral = test::arc({}, {0, 0, 1}, 0.0, b * turn, 0.0, turn, 0.0);
  EXPECT_NEAR(arc_length_mm(spiral),
              b / 2.0 * (turn * std::sqrt(1.0 + turn * turn) + std::asinh(turn)), 1e-10);
}

// Chords know nothing of the integral; 20 000 of them are short of the arc by 10⁻⁸ or so.
RC_GTEST_PROP(Segment, LengthIsTheSumOfManyChords, ()) {
  const PathSegment segment = *test::any_segment();
  const int count = 20000;
  double sum = 0.0;
  Point before = point_at(segment, 0.0);
  for (int i = 1; i <= count; ++i) {
    const Point here = point_at(segment, static_cast<double>(i) / count);
    sum += distance(before, here);
    before = here;
  }
  RC_ASSERT(std::abs(sum - arc_length_mm(segment)) <= 1e-6 * (1.0 + sum));
}

// Spirals too, where the inverse has no closed form.
RC_GTEST_PROP(Segment, ParameterAndDistanceAreInverse, ()) {
  const PathSegment segment = *test::any_segment();
  const double u = *test::number(0.0, 1.0);
  RC_ASSERT(std::abs(parameter_at(segment, distance_at(segment, u)) - u) <= 1e-11);
}

// Central differences of the point along its length: error h²/6 of the third derivative.
RC_GTEST_PROP(Segment, TangentAndCurvatureAreTheDifferencesOfThePoint, ()) {
  const PathSegment segment = *test::any_segment();
  const double s = *test::number(0.1, 0.9) * segment.length_mm;
  const double h = 1e-3 * std::min(1.0, segment.length_mm);
  const Station here = station_at(segment, parameter_at(segment, s));
  const Point before = point_at(segment, parameter_at(segment, s - h));
  const Point after = point_at(segment, parameter_at(segment, s + h));
  const Point tangent = scale(subtract(after, before), 0.5 / h);
  const Point curvature =
      scale(subtract(add(after, before), scale(here.point_mm, 2.0)), 1.0 / (h * h));
  RC_ASSERT(distance(tangent, here.tangent) <= 1e-4);
  RC_ASSERT(distance(curvature, here.curvature_1_mm) <= 1e-2 * (1.0 + norm(curvature)));
}

}  // namespace
}  // namespace steadyrest::math::geometry
