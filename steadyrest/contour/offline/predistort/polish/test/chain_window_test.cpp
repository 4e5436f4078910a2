// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <cmath>
#include <numbers>

#include <gtest/gtest.h>

#include <steadyrest/contour/offline/predistort/polish/chain_window.hpp>
#include <steadyrest/contour/offline/predistort/polish/test/mill.hpp>

namespace steadyrest::contour::offline {
namespace {

using kernel::signal::Point;
using std::numbers::pi;

constexpr double kRadius_mm = 2.0;
constexpr double kFeed_mm_s = 40.0;
constexpr double kLine_mm = 15.0;

ChainPiece piece(const Heading& start, double curvature, double length) {
  ChainPiece out;
  out.arc = {start, curvature, length};
  out.feed_mm_s = out.programmed_mm_s = kFeed_mm_s;
  return out;
}

/// A line, a fillet in three arcs and a line.
std::vector<ChainPiece> fillet() {
  std::vector<ChainPiece> out{piece({.x_mm = -kLine_mm}, 0.0, kLine_mm)};
  for (int i = 0; i < 3; ++i) {
    const PlanarArc& last = out.back().arc;
    out.push_back(
        piece(along(last, last.length_mm), 1.0 / kRadius_mm, kRadius_mm * pi / 2.0 / 3.0));
  }
  const PlanarArc& last = out.back().arc;
  out.push_back(piece(along(last, last.length_mm), 0.0, kLine_mm));
  return out;
}

std::vector<kernel::signal::PathSegment> path() {
  std::vector<kernel::signal::PathSegment> out(3);
  for (auto& segment : out) {
    segment.motion = kernel::signal::Motion::feed;
    segment.feed_mm_s = kFeed_mm_s;
  }
  out[0].start_mm = {-kLine_mm, 0.0, 0.0};
  out[0].length_mm = out[2].length_mm = kLine_mm;
  out[1].geometry = kernel::signal::Geometry::arc;
  out[1].centre_mm = {0.0, kRadius_mm, 0.0};
  out[1].axis = {0.0, 0.0, 1.0};
  out[1].radius_mm = out[1].radius_end_mm = kRadius_mm;
  out[1].sweep_rad = pi / 2.0;
  out[1].end_mm = out[2].start_mm = {kRadius_mm, kRadius_mm, 0.0};
  out[1].length_mm = kRadius_mm * pi / 2.0;
  out[2].end_mm = {kRadius_mm, kRadius_mm + kLine_mm, 0.0};
  out[1].position_mm = kLine_mm;
  out[2].position_mm = kLine_mm + out[1].length_mm;
  return out;
}

/// Largest distance from the path, by formulas of this test, while the first-order servo follows.
double largest_error_mm(const std::vector<ChainPiece>& chain, double& seconds) {
  const auto machine = slow_mill();
  ChainMotion motion(machine, nc::interpret::Plane::xy, 1);
  EXPECT_TRUE(motion.run(chain, 0.3));
  seconds = motion.begin_s().back();
  double out = 0.0;
  for (const Point& x : first_order(motion.command(), kMillGain_1_s, 0.001)) {
    const double error = x[0] <= 0.0 ? std::abs(x[1])
                         : x[1] >= kRadius_mm
                             ? std::abs(x[0] - kRadius_mm)
                             : std::abs(std::hypot(x[0], x[1] - kRadius_mm) - kRadius_mm);
    out = std::max(out, error);
  }
  return out;
}

ChainError::Config axes_like(const kernel::machine::Machine& machine) {
  ChainError::Config out;
  out.models = servo_models(machine.axes);
  return out;
}

class Fillet : public testing::Test {
 protected:
  ChainWindow::Task task() const {
    ChainWindow::Task out;
    out.chain = fillet();
    out.first = 1;
    out.last = 4;
    out.rest_s = 0.25;
    out.start.at.axes.tool_mm = {-kLine_mm, 0.0, 0.0};
    return out;
  }
  kernel::machine::Machine machine_ = slow_mill();
  std::vector<kernel::signal::PathSegment> path_ = path();
  ChainMotion motion_{machine_, nc::interpret::Plane::xy, 1};
  ChainError error_{axes_like(machine_), path_};
};

// The same servo, written on its own, sees what the window's model promises.
TEST_F(Fillet, AnotherServoSeesThatItIsFollowedBetter) {
  double before_s = 0.0;
  const double before_mm = largest_error_mm(fillet(), before_s);
  EXPECT_GT(before_mm, 0.5);
  ChainWindow window(motion_, error_, {}, 0.001, 0.25);
  auto now = task();
  for (int i = 0; i < 3; ++i) {
    const auto better = window.improve(now);
    ASSERT_TRUE(better);
    EXPECT_LE(better->after, better->before);
    now.chain = better->chain;
  }
  double after_s = 0.0;
  EXPECT_LT(largest_error_mm(now.chain, after_s), 0.2 * before_mm);
  EXPECT_LT(after_s, before_s + 0.1);
  // It goes on without a bend.
  for (std::size_t i = 1; i < now.chain.size(); ++i) {
    const PlanarArc& one = now.chain[i - 1].arc;
    const Heading end = along(one, one.length_mm);
    const Heading& start = now.chain[i].arc.start;
    EXPECT_NEAR(std::remainder(end.angle_rad - start.angle_rad, 2.0 * pi), 0.0, 1e-9);
    EXPECT_NEAR(std::hypot(end.x_mm - start.x_mm, end.y_mm - start.y_mm), 0.0, 1e-9);
  }
}

TEST_F(Fillet, ADearSecondIsNotSpent) {
  ChainWindow cheap(motion_, error_, {.time = 0.5}, 0.001, 0.25);
  ChainWindow dear(motion_, error_, {.time = 500.0}, 0.001, 0.25);
  const auto slow = cheap.improve(task());
  const auto fast = dear.improve(task());
  ASSERT_TRUE(slow && fast);
  double slow_s = 0.0;
  double fast_s = 0.0;
  EXPECT_LT(largest_error_mm(slow->chain, slow_s), largest_error_mm(fast->chain, fast_s));
  EXPECT_GT(slow_s, fast_s);
}

TEST_F(Fillet, WhatIsGoodStays) {
  auto straight = task();
  for (ChainPiece& piece : straight.chain) {
    piece.arc.curvature_1_mm = 0.0;
  }
  auto& chain = straight.chain;
  for (std::size_t i = 1; i < chain.size(); ++i) {
    chain[i].arc.start = along(chain[i - 1].arc, chain[i - 1].arc.length_mm);
  }
  std::vector<kernel::signal::PathSegment> line(1);
  line[0].motion = kernel::signal::Motion::feed;
  line[0].feed_mm_s = kFeed_mm_s;
  line[0].start_mm = {-kLine_mm, 0.0, 0.0};
  line[0].end_mm = {60.0, 0.0, 0.0};
  line[0].length_mm = 60.0 + kLine_mm;
  ChainError error(axes_like(machine_), line);
  ChainWindow window(motion_, error, {}, 0.001, 0.25);
  const auto same = window.improve(straight);
  ASSERT_TRUE(same);
  EXPECT_EQ(same->before, same->after);
  EXPECT_NEAR(same->chain[2].arc.length_mm, chain[2].arc.length_mm, 1e-9);
}

}  // namespace
}  // namespace steadyrest::contour::offline
