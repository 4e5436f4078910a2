// SPDX-License-Identifier: Apache-2.0
// Pieces of a command: arcs at random against Euclid, and parts that share the progress.
#include <cmath>
#include <numbers>

#include <gtest/gtest.h>
#include <rapidcheck/gtest.h>

#include <steadyrest/contour/offline/predistort/shape/piece.hpp>
#include <steadyrest/math/geometry/segment.hpp>
#include <steadyrest/math/geometry/vector.hpp>

namespace steadyrest::contour::offline {
namespace {

namespace geometry = math::geometry;
using kernel::signal::Point;
using nc::interpret::Plane;

TEST(PartOfAPiece, SharesItsProgress) {
  Piece piece;
  piece.segment = *arc_from_tangent(Plane::xy, {10, 0, 0}, {0, 1, 0}, {0, 10, 0});
  piece.progress_start_mm = 100.0;
  piece.progress_end_mm = 110.0;
  const Piece part = part_of(piece, 1.0 / 3.0, 1.0);
  EXPECT_NEAR(part.segment.sweep_rad, std::numbers::pi / 3.0, 1e-12);
  EXPECT_LT(geometry::distance(part.segment.start_mm, {5.0 * std::numbers::sqrt3, 5, 0}), 1e-9);
  EXPECT_EQ(part.segment.end_mm, piece.segment.end_mm);
  EXPECT_NEAR(part.progress_start_mm, 100.0 + 10.0 / 3.0, 1e-9);
  EXPECT_EQ(part.progress_end_mm, 110.0);
}

// LinuxCNC 2.9 makes a whole circle of an arc that turns by less than 1e-6 rad.
TEST(PieceArc, IsWrittenAsOneUnlessItIsAlmostStraight) {
  const auto arc = [](double radius_mm, double sweep_rad) {
    const Point end{radius_mm * std::sin(sweep_rad), radius_mm * (1.0 - std::cos(sweep_rad)), 0.0};
    return *arc_from_tangent(Plane::xy, {0, 0, 0}, {1, 0, 0}, end);
  };
  EXPECT_FALSE(is_written_as_arc(arc(2500.0, 3.4e-6)));
  EXPECT_TRUE(is_written_as_arc(arc(2500.0, 1e-4)));
  EXPECT_TRUE(is_written_as_arc(arc(2.0, 0.01)));
  EXPECT_FALSE(is_written_as_arc(arc(0.5, 0.008)));  // 4 µm long
}

RC_GTEST_PROP(PieceArc, LeavesAlongTheTangentAndArrives, ()) {
  const Plane plane = *rc::gen::element(Plane::xy, Plane::zx, Plane::yz);
  const auto axes = nc::interpret::axes_of(plane);
  const double heading = 0.001 * *rc::gen::inRange(0, 6283);
  const double bearing = heading + 0.001 * *rc::gen::inRange(20, 3100) * *rc::gen::element(-1, 1);
  const double chord_mm = 0.1 * *rc::gen::inRange(1, 500);
  Point start{1.0, -2.0, 3.0};
  Point tangent{};
  Point end = start;
  tangent[axes.first] = std::cos(heading);
  tangent[axes.second] = std::sin(heading);
  end[axes.first] += chord_mm * std::cos(bearing);
  end[axes.second] += chord_mm * std::sin(bearing);
  const auto arc = arc_from_tangent(plane, start, tangent, end);
  RC_ASSERT(arc.has_value());
  RC_ASSERT(geometry::distance(geometry::station_at(*arc, 0.0).tangent, tangent) < 1e-9);
  RC_ASSERT(geometry::distance(geometry::point_at(*arc, 1.0), end) < 1e-6);
  // The angle between tangent and chord is half of the sweep (Euclid III.32).
  RC_ASSERT(std::abs(arc->sweep_rad - 2.0 * std::abs(bearing - heading)) < 1e-6);
}

}  // namespace
}  // namespace steadyrest::contour::offline
