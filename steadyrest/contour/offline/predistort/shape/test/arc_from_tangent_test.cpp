// SPDX-License-Identifier: Apache-2.0
// Pieces of a command: the arc from a point and a direction, against circles drawn by hand.
#include <cmath>
#include <numbers>

#include <gtest/gtest.h>

#include <steadyrest/contour/offline/predistort/shape/piece.hpp>
#include <steadyrest/math/geometry/segment.hpp>
#include <steadyrest/math/geometry/vector.hpp>

namespace steadyrest::contour::offline {
namespace {

namespace geometry = math::geometry;
using kernel::signal::Point;
using nc::interpret::Plane;

// From (10, 0) upwards to (0, 10): the quarter about the origin, to the left.
TEST(ArcFromTangent, FindsTheQuarterCircle) {
  const auto arc = arc_from_tangent(Plane::xy, {10, 0, 4}, {0, 1, 0}, {0, 10, 4});
  ASSERT_TRUE(arc);
  EXPECT_LT(geometry::distance(arc->centre_mm, {0, 0, 4}), 1e-12);
  EXPECT_NEAR(arc->radius_mm, 10.0, 1e-12);
  EXPECT_NEAR(arc->sweep_rad, std::numbers::pi / 2.0, 1e-12);
  EXPECT_NEAR(arc->length_mm, 5.0 * std::numbers::pi, 1e-12);
  EXPECT_EQ(arc->axis, (Point{0, 0, 1}));
  // Downwards to the same point it is three quarters of a turn, to the right.
  const auto round = arc_from_tangent(Plane::xy, {10, 0, 4}, {0, -1, 0}, {0, 10, 4});
  ASSERT_TRUE(round);
  EXPECT_NEAR(round->sweep_rad, 1.5 * std::numbers::pi, 1e-12);
  EXPECT_EQ(round->axis, (Point{0, 0, -1}));
}

// G18 turns from Z to X: seen along Y it starts at Z and goes to X.
TEST(ArcFromTangent, TurnsFromZToXInG18) {
  const auto arc = arc_from_tangent(Plane::zx, {0, 2, 5}, {1, 0, 0}, {5, 2, 0});
  ASSERT_TRUE(arc);
  EXPECT_EQ(arc->axis, (Point{0, 1, 0}));
  EXPECT_LT(geometry::distance(geometry::point_at(*arc, 0.5), {5.0 * std::numbers::sqrt2 / 2.0, 2.0,
                                                               5.0 * std::numbers::sqrt2 / 2.0}),
            1e-12);
}

// A helix of one pitch in half a turn: the length is that of the slope unrolled.
TEST(ArcFromTangent, RisesToTheEndPoint) {
  const auto arc = arc_from_tangent(Plane::xy, {3, 0, 0}, {0, 1, 0}, {-3, 1e-9, 4});
  ASSERT_TRUE(arc);
  EXPECT_NEAR(arc->sweep_rad, std::numbers::pi, 1e-6);
  EXPECT_NEAR(arc->length_mm, std::hypot(3.0 * std::numbers::pi, 4.0), 1e-6);
  EXPECT_LT(geometry::distance(geometry::point_at(*arc, 1.0), {-3, 0, 4}), 1e-6);
}

TEST(ArcFromTangent, OfALineIsNothing) {
  EXPECT_FALSE(arc_from_tangent(Plane::xy, {0, 0, 0}, {1, 0, 0}, {7, 0, 0}));
  EXPECT_FALSE(arc_from_tangent(Plane::xy, {0, 0, 0}, {0, 0, 1}, {7, 1, 0})) << "no direction";
  EXPECT_FALSE(arc_from_tangent(Plane::xy, {1, 1, 0}, {1, 0, 0}, {1, 1, 5})) << "no chord";
  // A chord of 10 mm on a radius R deviates by 50/R: R = 3 m is 16.7 µm.
  EXPECT_FALSE(arc_from_tangent(Plane::xy, {0, 0, 0}, {1, 0, 0}, {10, 0.0166, 0}));
  EXPECT_TRUE(arc_from_tangent(Plane::xy, {0, 0, 0}, {1, 0, 0}, {10, 0.0168, 0}));
}

}  // namespace
}  // namespace steadyrest::contour::offline
