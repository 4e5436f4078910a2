// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <cmath>
#include <span>
#include <vector>

#include <gtest/gtest.h>

#include <steadyrest/contour/offline/predistort/polish/chain_corner.hpp>
#include <steadyrest/contour/offline/predistort/polish/chain_window.hpp>
#include <steadyrest/contour/offline/predistort/polish/test/mill.hpp>

namespace steadyrest::contour::offline {
namespace {

using kernel::signal::Point;

constexpr double kFeed_mm_s = 40.0;
constexpr double kLine_mm = 15.0;

ChainPiece line(double x_mm, double y_mm, double to_x_mm, double to_y_mm) {
  ChainPiece out;
  out.arc = {{x_mm, y_mm, std::atan2(to_y_mm - y_mm, to_x_mm - x_mm)},
             0.0,
             std::hypot(to_x_mm - x_mm, to_y_mm - y_mm)};
  out.feed_mm_s = out.programmed_mm_s = kFeed_mm_s;
  return out;
}

/// Along X to the origin, a little further, and by a straight way on along Y.
std::vector<ChainPiece> corner() {
  std::vector<ChainPiece> out{line(-kLine_mm, 0.0, 0.2, 0.0), line(0.2, 0.0, 0.0, 0.2),
                              line(0.0, 0.2, 0.0, kLine_mm)};
  out[1].smooth = out[2].smooth = false;
  return out;
}

std::vector<kernel::signal::PathSegment> corner_path() {
  std::vector<kernel::signal::PathSegment> out(2);
  for (auto& segment : out) {
    segment.motion = kernel::signal::Motion::feed;
    segment.feed_mm_s = kFeed_mm_s;
    segment.length_mm = kLine_mm;
  }
  out[0].start_mm = {-kLine_mm, 0.0, 0.0};
  out[1].end_mm = {0.0, kLine_mm, 0.0};
  out[1].position_mm = kLine_mm;
  return out;
}

/// Passes corners at speed, as an 840D does.
kernel::machine::Machine passing_mill(double block_time_s) {
  auto machine = slow_mill();
  machine.control.junction_share = 1.0;
  machine.control.junction_deviation_mm = 0.01;
  machine.control.block_time_s = block_time_s;
  return machine;
}

struct Seen {
  double rms_mm = 0.0;
  double across_s = 0.0;  ///< from the tip to the path
};

/// Distance from the path, by formulas of this test, while the first-order servo follows.
Seen seen(const std::vector<ChainPiece>& chain, double block_time_s) {
  const auto machine = passing_mill(block_time_s);
  ChainMotion motion(machine, nc::interpret::Plane::xy, 1);
  EXPECT_TRUE(motion.run(chain, 0.3));
  double sum = 0.0;
  const auto tool = first_order(motion.command(), kMillGain_1_s, 0.001);
  for (const Point& x : tool) {
    const double to_x = x[0] <= 0.0 ? std::abs(x[1]) : std::hypot(x[0], x[1]);
    const double to_y = x[1] >= 0.0 ? std::abs(x[0]) : std::hypot(x[0], x[1]);
    sum += std::pow(std::min(to_x, to_y), 2);
  }
  return {.rms_mm = std::sqrt(sum / static_cast<double>(tool.size())),
          .across_s = motion.begin_s()[2] - motion.begin_s()[1]};
}

std::vector<ChainPiece> improved(double block_time_s) {
  const auto machine = passing_mill(block_time_s);
  const auto path = corner_path();
  ChainMotion motion(machine, nc::interpret::Plane::xy, 1);
  ChainError::Config config;
  config.models = servo_models(machine.axes);
  ChainError error(config, path);
  ChainWindow window(motion, error, {.least_piece_s = block_time_s}, 0.001, 0.25);
  ChainWindow::Task task;
  task.chain = corner();
  task.last = 3;
  task.leaves_free = task.arrives_free = true;
  task.corner = true;
  task.start.at.axes.tool_mm = {-kLine_mm, 0.0, 0.0};
  task.rest_s = 0.25;
  for (int i = 0; i < 3; ++i) {
    const auto better = window.improve(task);
    EXPECT_TRUE(better);
    EXPECT_LE(better->after, better->before);
    task.chain = better->chain;
  }
  return task.chain;
}

TEST(TurnCorner, MovesTheTipAndThePlaceWhereItIsOnThePathAgain) {
  auto way = corner();
  way[0].slope = way[2].slope = 0.1;
  way[2].height_mm = 2.0;
  const double from_mm = way[0].height_mm;
  const double before_mm = way[0].arc.length_mm;
  ASSERT_TRUE(turn_corner(std::span<ChainPiece, 3>(way), 0.3, 0.1));
  EXPECT_NEAR(way[0].arc.length_mm, before_mm + 0.3, 1e-12);
  EXPECT_NEAR(way[1].arc.start.x_mm, 0.5, 1e-12);
  EXPECT_NEAR(way[1].arc.length_mm, std::hypot(0.5, 0.3), 1e-12);
  EXPECT_NEAR(way[1].arc.start.angle_rad, std::atan2(0.3, -0.5), 1e-12);
  EXPECT_NEAR(way[2].arc.start.y_mm, 0.3, 1e-12);
  EXPECT_NEAR(along(way[2].arc, way[2].arc.length_mm).y_mm, kLine_mm, 1e-12);
  // It rises without a step.
  EXPECT_NEAR(way[1].height_mm, from_mm + 0.1 * (before_mm + 0.3), 1e-12);
  EXPECT_NEAR(way[1].height_mm + way[1].slope * way[1].arc.length_mm, way[2].height_mm, 1e-12);
  EXPECT_NEAR(way[2].height_mm, 2.01, 1e-12);
}

TEST(TurnCorner, RefusesToLeaveNothingOfAPiece) {
  auto way = corner();
  EXPECT_FALSE(turn_corner(std::span<ChainPiece, 3>(way), -kLine_mm - 0.2, 0.0));
  way = corner();
  EXPECT_FALSE(turn_corner(std::span<ChainPiece, 3>(way), 0.0, kLine_mm));
  way = corner();
  EXPECT_FALSE(turn_corner(std::span<ChainPiece, 3>(way), -0.2, -0.2));  // the corner itself
}

// The same servo, written on its own, sees what the window's model promises.
TEST(TurnCorner, AnotherServoIsNearerToTheCornerWhateverTheBlockTime) {
  for (const double block_time_s : {0.001, 0.010, 0.020}) {
    const auto made = improved(block_time_s);
    const Seen now = seen(made, block_time_s);
    EXPECT_LT(now.rms_mm, 0.5 * seen(corner(), block_time_s).rms_mm) << block_time_s;
    // No block is shorter than the control can take.
    EXPECT_GE(now.across_s, 0.95 * block_time_s);
  }
}

}  // namespace
}  // namespace steadyrest::contour::offline
