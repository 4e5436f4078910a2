// SPDX-License-Identifier: Apache-2.0
// Commands beside the path: for unequal axes, and for what records have taught.
#include <algorithm>
#include <numbers>

#include <gtest/gtest.h>

#include <steadyrest/contour/offline/predistort/shape/test/shape_scene.hpp>

namespace steadyrest::contour::offline {
namespace {

using kernel::signal::Point;
using test::ShapeScene;

// Each axis needs its own v/k ahead: at 45° the command runs (v/2)·|1/kx − 1/ky| beside the line.
TEST(CommandShapeBeside, OfALineOnUnequalAxesRunsBesideIt) {
  ShapeScene scene(ShapeScene::from({0, 0, 0}).line_to({60, 60, 0}).path());
  scene.model[1].gain_1_s = 40.0;
  // The slowest axis, 1/40 s behind, leads.
  const double beside_mm = 0.5 * 40.0 * (1.0 / 40.0 - 1.0 / 50.0);
  bool inside = false;
  for (const Piece& piece : scene.pieces()) {
    if (scene.is_inside(piece)) {
      inside = true;
      const Point& at = piece.segment.start_mm;
      EXPECT_NEAR((at[1] - at[0]) / std::numbers::sqrt2, beside_mm, 2e-3);
    }
  }
  EXPECT_TRUE(inside);
}

// Of what was learnt the curve takes over 10 µm to the left, and fades it out at its ends.
TEST(CommandShapeBeside, IsDisplacedByWhatWasLearnt) {
  ShapeScene scene(ShapeScene::from({0, 0, 0}).line_to({60, 0, 0}).path());
  scene.learnt.add(
      {{.from_mm = 0.0, .to_mm = 60.0, .knots = {{.at_mm = 30.0, .shift_mm = {0.0, 0.010, 0.0}}}}});
  const auto pieces = scene.pieces();
  ASSERT_GE(pieces.size(), 3U);
  EXPECT_EQ(pieces.front().segment.start_mm[1], 0.0);
  EXPECT_EQ(pieces.back().segment.end_mm[1], 0.0);
  const auto middle =
      std::ranges::find_if(pieces, [](const Piece& piece) { return piece.progress_end_mm > 30.0; });
  ASSERT_NE(middle, pieces.end());
  // The fit may miss by 1 µm.
  EXPECT_NEAR(middle->segment.start_mm[1], 0.010, 1.2e-3);
  EXPECT_NEAR(middle->segment.end_mm[1], 0.010, 1.2e-3);
}

}  // namespace
}  // namespace steadyrest::contour::offline
