// SPDX-License-Identifier: Apache-2.0
// The command for a tool on the path, within blocks: closed forms of the servo's inverse.
#include <cmath>

#include <gtest/gtest.h>

#include <steadyrest/contour/offline/predistort/shape/test/shape_scene.hpp>
#include <steadyrest/math/geometry/segment.hpp>
#include <steadyrest/math/geometry/vector.hpp>

namespace steadyrest::contour::offline {
namespace {

namespace geometry = math::geometry;
using kernel::signal::Geometry;
using test::ShapeScene;

// On the circle the command runs on R·√(1 + q²) about the same centre, q = v/(R·k), and v is the
// tool's speed: the command's over √(1 + q²).
TEST(CommandShape, OfACircleIsTheWiderCircle) {
  constexpr double kWidened_mm = 5.0;
  const ShapeScene scene(ShapeScene::from({kWidened_mm, 0, 0}).arc({0, 0, 0}, 30.0).path());
  const double w = ShapeScene::kLead_mm / kWidened_mm;               // q·√(1 + q²)
  const double square = 0.5 * (1.0 + std::sqrt(1.0 + 4.0 * w * w));  // 1 + q²
  const double wider_mm = kWidened_mm * std::sqrt(square);
  int inside = 0;
  for (const Piece& piece : scene.pieces()) {
    if (scene.is_inside(piece)) {
      ++inside;
      ASSERT_EQ(piece.segment.geometry, Geometry::arc);
      EXPECT_NEAR(piece.segment.radius_mm, wider_mm, 2e-3);
      EXPECT_LT(geometry::norm(piece.segment.centre_mm), 2e-3);
      EXPECT_NEAR(piece.segment.feed_mm_s, ShapeScene::kFeed_mm_s * std::sqrt(square), 0.05);
    }
  }
  EXPECT_GE(inside, 5);
}

TEST(CommandShape, OfALineOnEqualAxesIsTheLine) {
  const ShapeScene scene(ShapeScene::from({0, 0, 0}).line_to({30, 40, 0}).path());
  const auto pieces = scene.pieces();
  ASSERT_EQ(pieces.size(), 1U);
  EXPECT_EQ(pieces[0].segment.geometry, Geometry::line);
  EXPECT_LT(geometry::distance(pieces[0].segment.start_mm, {0, 0, 0}), 1e-9);
  EXPECT_LT(geometry::distance(pieces[0].segment.end_mm, {30, 40, 0}), 1e-9);
  EXPECT_NEAR(pieces[0].segment.feed_mm_s, ShapeScene::kFeed_mm_s, 1e-9);
  EXPECT_TRUE(pieces[0].begins_run);
}

TEST(CommandShape, TakesTheProgramsTime) {
  const ShapeScene scene(
      ShapeScene::from({0, 0, 0}).line_to({20, 0, 0}).arc({20, 6, 0}, 3.0).path());
  double seconds = 0.0;
  for (const Piece& piece : scene.pieces()) {
    seconds += piece.segment.length_mm / piece.segment.feed_mm_s;
  }
  const double whole_mm = 20.0 + 18.0;
  EXPECT_NEAR(seconds, whole_mm / ShapeScene::kFeed_mm_s, 1e-3);
}

}  // namespace
}  // namespace steadyrest::contour::offline
