// SPDX-License-Identifier: Apache-2.0
// Where a block's command ends: beyond the joint by what the tool is behind, or at the path's own
// point where the tool must come to it.
#include <cmath>

#include <gtest/gtest.h>

#include <steadyrest/contour/offline/predistort/shape/test/shape_scene.hpp>
#include <steadyrest/math/geometry/vector.hpp>

namespace steadyrest::contour::offline {
namespace {

namespace geometry = math::geometry;
using kernel::signal::Point;
using test::ShapeScene;

/// 30 mm along X, then 30 mm at this angle to it.
ShapeScene bent_by(double angle_rad) {
  return ShapeScene(ShapeScene::from({0, 0, 0})
                        .line_to({30, 0, 0})
                        .line_to({30.0 + 30.0 * std::cos(angle_rad), 30.0 * std::sin(angle_rad), 0})
                        .path());
}

/// Where the second block's command begins; the first one's ends there too.
Point joint_of(const ShapeScene& scene) {
  const Point end = scene.pieces_of(1).back().segment.end_mm;
  EXPECT_LT(geometry::distance(end, scene.pieces_of(2).front().segment.start_mm), 1e-12);
  return end;
}

// The tool is on the first block until the command is v·L = 0.8 mm into the second.
TEST(CommandShapeJoints, MoveByTheLagAlongTheTangent) {
  const ShapeScene scene = bent_by(0.0);
  EXPECT_LT(geometry::distance(joint_of(scene), {30.8, 0, 0}), 1e-6);
  EXPECT_NEAR(scene.pieces_of(1).back().progress_end_mm, 30.8, 1e-6);
  EXPECT_TRUE(scene.pieces_of(2).front().joined);
  EXPECT_FALSE(scene.pieces_of(2).front().begins_run);
}

// One side asks for 0.8 mm straight on, the other for 0.8 mm along the next chord.
TEST(CommandShapeJoints, OfChordsMeetHalfWay) {
  for (const double angle : {0.1, -0.3}) {
    const Point wanted = {30.0 + 0.4 + 0.4 * std::cos(angle), 0.4 * std::sin(angle), 0.0};
    EXPECT_LT(geometry::distance(joint_of(bent_by(angle)), wanted), 1e-6) << angle;
  }
}

// |t′ − t| = 2·sin(φ/2) is 0.8 at φ = 0.823.
TEST(CommandShapeJoints, ThatAreCornersAreThePathsOwnPoints) {
  EXPECT_GT(geometry::distance(joint_of(bent_by(0.82)), {30, 0, 0}), 0.5);
  const ShapeScene corner = bent_by(0.83);
  EXPECT_LT(geometry::distance(joint_of(corner), {30, 0, 0}), 1e-9);
  EXPECT_FALSE(corner.pieces_of(2).front().joined);
  EXPECT_NEAR(corner.pieces_of(1).back().progress_end_mm, 30.0, 1e-9);
}

TEST(CommandShapeJoints, ThatStopAreThePathsOwnPoints) {
  ShapeScene scene = bent_by(0.0);
  scene.use[0].stops = true;
  EXPECT_LT(geometry::distance(joint_of(scene), {30, 0, 0}), 1e-9);
  EXPECT_FALSE(scene.pieces_of(2).front().joined);
  EXPECT_FALSE(scene.pieces_of(2).front().passes);
}

// A corner crept through at less than a twentieth of the feed is as good as a stop.
TEST(CommandShapeJoints, TellWhetherTheControlPassesACornerAtSpeed) {
  ShapeScene scene = bent_by(1.5);
  EXPECT_TRUE(scene.pieces_of(2).front().passes);
  scene.path.segments[0].exit_speed_limit_mm_s = 0.06 * ShapeScene::kFeed_mm_s;
  EXPECT_TRUE(scene.pieces_of(2).front().passes);
  scene.path.segments[0].exit_speed_limit_mm_s = 0.04 * ShapeScene::kFeed_mm_s;
  EXPECT_FALSE(scene.pieces_of(2).front().passes);
}

TEST(CommandShapeJoints, BesideABlockThatStaysAreThePathsOwnPoints) {
  ShapeScene scene(ShapeScene::from({0, 0, 0})
                       .line_to({30, 0, 0})
                       .line_to({60, 0, 0})
                       .line_to({90, 0, 0})
                       .path());
  scene.use[1].free = false;
  EXPECT_TRUE(scene.pieces_of(2).empty());
  EXPECT_LT(geometry::distance(scene.pieces_of(1).back().segment.end_mm, {30, 0, 0}), 1e-9);
  const auto after = scene.pieces_of(3);
  EXPECT_LT(geometry::distance(after.front().segment.start_mm, {60, 0, 0}), 1e-9);
  EXPECT_TRUE(after.front().begins_run);
  EXPECT_NEAR(after.front().progress_start_mm, 60.0, 1e-9);
}

}  // namespace
}  // namespace steadyrest::contour::offline
