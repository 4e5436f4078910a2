// SPDX-License-Identifier: Apache-2.0
#include <cmath>
#include <vector>

#include <gtest/gtest.h>

#include <steadyrest/contour/offline/predistort/corner_errors.hpp>
#include <steadyrest/contour/offline/predistort/shape/joints.hpp>
#include <steadyrest/contour/offline/predistort/shift.hpp>
#include <steadyrest/contour/online/test/paths.hpp>
#include <steadyrest/math/geometry/segment.hpp>
#include <steadyrest/math/geometry/vector.hpp>

namespace steadyrest::contour::offline {
namespace {

namespace geometry = math::geometry;
using kernel::signal::Geometry;
using kernel::signal::Point;
using online::test::PathMaker;

constexpr double kKinkFeed_mm_s = 50.0;

nc::plan::PathLimits limits() {
  std::vector<kernel::machine::Axis> axes(3);
  kernel::machine::Control control;
  control.junction_deviation_mm = 0.0;
  return {axes, control};
}

std::vector<Piece> pieces(const std::vector<Point>& corners) {
  std::vector<Piece> out;
  double progress = 0.0;
  for (std::size_t i = 0; i + 1 < corners.size(); ++i) {
    Piece piece;
    piece.segment = line_segment(corners[i], corners[i + 1]);
    piece.segment.feed_mm_s = kKinkFeed_mm_s;
    piece.segment.line = static_cast<std::uint32_t>(i + 1);
    piece.progress_start_mm = progress;
    progress += piece.segment.length_mm;
    piece.progress_end_mm = progress;
    piece.begins_run = i == 0;
    piece.joined = i > 0;
    out.push_back(piece);
  }
  return out;
}

/// Contiguous in place and in progress.
void expect_whole(const std::vector<Piece>& made) {
  for (std::size_t i = 0; i + 1 < made.size(); ++i) {
    EXPECT_LT(geometry::distance(made[i].segment.end_mm, made[i + 1].segment.start_mm), 1e-9);
    EXPECT_NEAR(made[i].progress_end_mm, made[i + 1].progress_start_mm, 1e-9);
  }
}

// Truth: v²/r takes the share of the acceleration, and a circle of radius r that rounds a bend of φ
// takes r·tan(φ/2) of either line.
TEST(RoundKinks, TakeTheBendAtFullSpeed) {
  const double bend = 0.4;
  const auto made = round_kinks(
      pieces({{0, 0, 0}, {20, 0, 0}, {20 + 20 * std::cos(bend), 20 * std::sin(bend), 0}}), limits(),
      0.9);
  ASSERT_EQ(made.size(), 3U);
  const auto& arc = made[1].segment;
  ASSERT_EQ(arc.geometry, Geometry::arc);
  const double radius = kKinkFeed_mm_s * kKinkFeed_mm_s / (0.9 * 0.866 * 2000.0);
  EXPECT_NEAR(arc.radius_mm, radius, 1e-3 * radius);
  EXPECT_NEAR(arc.sweep_rad, bend, 1e-6);
  EXPECT_NEAR(made[0].segment.end_mm[0], 20.0 - radius * std::tan(bend / 2.0), 1e-3);
  EXPECT_NEAR(arc.feed_mm_s, kKinkFeed_mm_s, 1e-12);
  expect_whole(made);
}

TEST(RoundKinks, LeaveWhatTheControlPassesAtSpeed) {
  const auto straight = pieces({{0, 0, 0}, {20, 0, 0}, {40, 0.001, 0}});
  EXPECT_EQ(round_kinks(straight, limits(), 0.9).size(), 2U);
  auto corner = pieces({{0, 0, 0}, {20, 0, 0}, {20, 20, 0}});
  corner[1].joined = false;  // the original has a corner here
  EXPECT_EQ(round_kinks(corner, limits(), 0.9).size(), 2U);
}

// An arc in space cannot be written.
TEST(RoundKinks, LeaveBendsOutOfThePlane) {
  const auto made = round_kinks(pieces({{0, 0, 0}, {20, 0, 0}, {40, 0, 8}}), limits(), 0.9);
  EXPECT_EQ(made.size(), 2U);
}

/// A tool that is 1 mm behind a command at 50 mm/s.
ToolMotion motion_along(const std::vector<Point>& corners, nc::plan::PlannedPath& path) {
  PathMaker maker(corners.front(), kKinkFeed_mm_s);
  for (std::size_t i = 1; i < corners.size(); ++i) {
    maker.line_to(corners[i]);
  }
  path.segments = maker.path();
  CommandSpeed speed;
  speed.add(0.0, kKinkFeed_mm_s);
  speed.add(1000.0, kKinkFeed_mm_s);
  const online::AxisModel axis{.gain_1_s = 50.0};
  return {ServoInverse({axis, axis, axis}), path, speed};
}

TEST(LeadCorners, GoBeyondByTheShareOfTheLag) {
  const std::vector<Point> corners = {{0, 0, 0}, {20, 0, 0}, {20, 20, 0}};
  nc::plan::PlannedPath path;
  const ToolMotion motion = motion_along(corners, path);
  auto at_corner = pieces(corners);
  at_corner[1].joined = false;
  at_corner[1].passes = true;
  std::vector<Corner> found;
  const auto made = lead_corners(at_corner, motion, found);
  ASSERT_EQ(found.size(), 1U);
  EXPECT_NEAR(found[0].at_mm, 20.0, 1e-9);
  EXPECT_NEAR(found[0].behind_mm, 1.0, 0.12);
  ASSERT_EQ(made.size(), 3U);
  EXPECT_NEAR(made[0].segment.end_mm[0], 20.0 + 0.6 * found[0].behind_mm, 1e-9);
  EXPECT_NEAR(made[2].segment.start_mm[1], 0.7 * found[0].behind_mm, 1e-9);
  expect_whole(made);
  // A share that is given for the place is taken; 0 leaves the corner.
  found[0].beyond = 0.0;
  EXPECT_EQ(lead_corners(at_corner, motion, found).size(), 2U);
  ASSERT_EQ(found.size(), 1U);
  EXPECT_EQ(found[0].beyond, 0.0);
}

TEST(LeadCorners, LeaveStopsAndCornersCloseToOthers) {
  const std::vector<Point> corners = {{0, 0, 0}, {20, 0, 0}, {20, 1, 0}, {0, 1, 0}};
  nc::plan::PlannedPath path;
  const ToolMotion motion = motion_along(corners, path);
  auto at_corners = pieces(corners);
  for (Piece& piece : at_corners) {
    piece.joined = false;
  }
  std::vector<Corner> found;
  EXPECT_EQ(lead_corners(at_corners, motion, found).size(), 3U) << "the control stops there";
  EXPECT_TRUE(found.empty());
  for (Piece& piece : at_corners) {
    piece.passes = true;
  }
  EXPECT_EQ(lead_corners(at_corners, motion, found).size(), 3U) << "1 mm apart, 1 mm behind";
  EXPECT_EQ(found.size(), 2U);
}

TEST(CornerErrors, BelongToTheCornerThatTheToolPasses) {
  const std::vector<Corner> corners = {{.at_mm = 10.0, .behind_mm = 1.0},
                                       {.at_mm = 30.0, .behind_mm = 1.0}};
  CornerErrors errors(corners);
  const auto sample = [&](double foot, double error, bool cuts = true) {
    ModelSample one;
    one.foot_mm = foot;
    one.error_mm = error;
    one.cuts = cuts;
    errors.add(one);
  };
  sample(5.0, 0.5);  // on the way there
  sample(9.0, -0.02);
  sample(11.0, 0.01);
  sample(20.0, 0.7);
  sample(30.5, 0.03);
  sample(31.0, 0.9, false);
  EXPECT_EQ(errors.take(), (std::vector<double>{0.02, 0.03}));
}

TEST(Shift, IsTheDistanceToThePathNearby) {
  nc::plan::PlannedPath path;
  path.segments = PathMaker({0, 0, 0}, 10.0).line_to({50, 0, 0}).line_to({50, 0.3, 0}).path();
  auto along = pieces({{0, 0.1, 0}, {20, 0.2, 0}, {40, 0.05, 0}});
  const Shift shift = shift_of(path, along, 0.15);
  EXPECT_NEAR(shift.largest_mm, 0.2, 1e-9);
  EXPECT_EQ(shift.too_far, (std::vector<std::uint32_t>{1, 2}));
  EXPECT_TRUE(shift_of(path, along, 0.25).too_far.empty());
}

}  // namespace
}  // namespace steadyrest::contour::offline
