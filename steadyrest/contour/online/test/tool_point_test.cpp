// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <array>
#include <cmath>
#include <complex>
#include <vector>

#include <gtest/gtest.h>
#include <rapidcheck/gtest.h>

#include <steadyrest/contour/online/test/closed_loop.hpp>
#include <steadyrest/contour/online/test/paths.hpp>
#include <steadyrest/contour/online/tool_point.hpp>
#include <steadyrest/math/geometry/test/segments.hpp>
#include <steadyrest/math/geometry/vector.hpp>

namespace steadyrest::contour::online {
namespace {

using math::geometry::test::number;
using test::kTurn;
using test::PathMaker;
using test::PathSegment;
using test::Point;

constexpr double kCycle_s = 0.001;

/// A path, its cells, and a tool point that follows a command along it.
class Follower {
 public:
  Follower(std::vector<PathSegment> path, const std::array<AxisModel, 3>& model,
           double most_behind_mm = 1.0, double tool_turn_mm_s = 3.0)
      : path_(std::move(path)),
        ahead_(test::mill().axes, kernel::machine::kUnlimited, tool_turn_mm_s),
        point_({.half_backlash_mm = {}, .most_behind_mm = most_behind_mm}) {
    for (int i = 0; i < 60; ++i) {
      ahead_.update(path_, 0, 0.0, 0.0, 60.0);
    }
    point_.set_model(model);
    state = point_.at(ahead_, 0.0, 0.0);
  }
  explicit Follower(std::vector<PathSegment> path, const AxisModel& model = {})
      : Follower(std::move(path), std::array{model, model, model}) {}

  /// The command moves on at this speed for a step.
  void step(double speed_mm_s) {
    const double to = command_mm + speed_mm_s * kCycle_s;
    point_.advance(ahead_, command_mm, to, kCycle_s, state);
    command_mm = to;
  }
  void run(double speed_mm_s, double time_s) {
    for (double t = 0.0; t < time_s; t += kCycle_s) {
      step(speed_mm_s);
    }
  }
  [[nodiscard]] Point command() const {
    const Cell& cell = ahead_.cell(ahead_.find(command_mm, ahead_.begin()));
    return on_cell(cell, command_mm - cell.position_mm);
  }
  [[nodiscard]] double lag_s() const { return point_.lag_s(); }

  ToolPoint::State state;
  double command_mm = 0.0;

 private:
  std::vector<PathSegment> path_;
  LookAhead ahead_;
  ToolPoint point_;
};

// Truth: the axis's transfer function G in complex numbers. A command of radius R/|G| comes out at
// R, a command that leads by −arg G comes out at the tool point's angle.
RC_GTEST_PROP(ToolPoint, OnACircleTheCommandIsTheInverseOfTheServo, ()) {
  const AxisModel model{*number(25.0, 90.0), *rc::gen::element(0.0, 0.4, 0.8),
                        *rc::gen::element(0.0, 0.003)};
  const double radius = *number(2.0, 40.0);
  const double speed = std::min(*number(5.0, 60.0), std::sqrt(1500.0 * radius));
  Follower follower(PathMaker({radius, 0, 0}, speed).arc({0, 0, 0}, 60.0 / radius + kTurn).path(),
                    model);
  follower.run(speed, std::min(0.9 * 60.0 / speed, 1.0));
  const std::complex<double> s(0.0, speed / radius);
  const auto servo = (model.gain_1_s + model.feed_forward * s) /
                     (model.velocity_lag_s * s * s + s + model.gain_1_s);
  const std::complex<double> command(follower.state.command_mm[0], follower.state.command_mm[1]);
  const auto tool = std::polar(radius, follower.state.position_mm / radius);
  // Cells are parabolas to 2·10⁻⁵ mm.
  RC_ASSERT(std::abs(servo * command - tool) < 1e-4);
  RC_ASSERT(std::abs(follower.command_mm - follower.state.position_mm - speed * follower.lag_s()) <
            1e-6 * radius);
}

// On a line the servo makes no contour error: whatever the speed does within the control's 2000
// mm/s², nothing is to be added.
RC_GTEST_PROP(ToolPoint, OnALineNothingIsAddedWhateverTheSpeedDoes, ()) {
  const Point end{*number(20.0, 40.0), *number(-40.0, 40.0), *number(-10.0, 10.0)};
  Follower follower(PathMaker({0, 0, 0}, 60.0).line_to(end).path());
  double speed = 0.0;
  for (int change = 0; change < 5; ++change) {
    const double goal = *number(0.0, 60.0);
    for (int i = 0; i < 50; ++i) {
      speed += std::clamp(goal - speed, -1.9, 1.9);
      follower.step(speed);
      RC_ASSERT(math::geometry::distance(follower.state.command_mm, follower.command()) < 1e-9);
    }
  }
}

// Unequal gains on a line at 30°: the axis with the larger gain is commanded behind. By hand, v =
// 40 mm/s: c′ − c = v·t·(1/k_i − 1/k_least).
TEST(ToolPoint, UnequalGainsAreLevelled) {
  const double angle = kTurn / 12.0;
  const Point along{std::cos(angle), std::sin(angle), 0.0};
  Follower follower(
      PathMaker({0, 0, 0}, 40.0).line_to({60 * along[0], 60 * along[1], 0}).path(),
      std::array{AxisModel{50.0, 0.0, 0.0}, AxisModel{55.0, 0.0, 0.0}, AxisModel{50.0, 0.0, 0.0}});
  follower.run(40.0, 0.8);
  EXPECT_NEAR(follower.state.command_mm[0] - follower.command()[0], 0.0, 1e-9);
  EXPECT_NEAR(follower.state.command_mm[1] - follower.command()[1],
              40.0 * along[1] * (1.0 / 55.0 - 1.0 / 50.0), 1e-9);
}

std::vector<PathSegment> right_angle(double speed) {
  auto path = PathMaker({0, 0, 0}, speed).line_to({20, 0, 0}).line_to({20, 30, 0}).path();
  for (auto& segment : path) {
    segment.exit_speed_limit_mm_s = speed;
  }
  return path;
}

// A turn by 90° changes the velocity by √2·v: at most 3 mm/s here, so v ≤ 2.12 mm/s at the corner.
// The command goes through at 20 mm/s, and all that is added is an offset along the path within
// its limit.
TEST(ToolPoint, SlowsDownForACornerAndCatchesUp) {
  Follower follower(right_angle(20.0));
  follower.run(20.0, 0.9);
  EXPECT_NEAR(follower.state.speed_mm_s, 20.0, 1e-6);
  double speed_at_corner = 1e9;
  double largest_mm = 0.0;
  while (follower.command_mm < 45.0) {
    const double before_mm = follower.state.position_mm;
    follower.step(20.0);
    if (before_mm < 20.0 && follower.state.position_mm >= 20.0) {
      speed_at_corner = follower.state.speed_mm_s;
    }
    for (std::size_t i = 0; i < 2; ++i) {
      largest_mm =
          std::max(largest_mm, std::abs(follower.state.command_mm[i] - follower.command()[i]));
    }
  }
  EXPECT_LE(speed_at_corner, 3.0 / std::sqrt(2.0) * 1.2)
      << "a step may go round it as it speeds up";
  EXPECT_GT(speed_at_corner, 1.0);
  EXPECT_GT(largest_mm, 0.4)
      << "v/k: for a moment the tool point nearly rests while the command runs";
  EXPECT_LT(largest_mm, 0.4 + 20.0 * 20.0 / (2.0 * 2000.0)) << "and the way that it brakes on";
  EXPECT_NEAR(follower.state.speed_mm_s, 20.0, 1e-3) << "caught up";
  EXPECT_NEAR(follower.state.position_mm, 45.0 - 0.4, 1e-3);
}

// With 0.1 mm to spare along the path it cannot slow down to 2.12 mm/s from 20: it may be slower
// than (s_c − s)/L by 5 mm/s.
TEST(ToolPoint, NeverFallsBehindByMoreThanTheOffsetAllows) {
  Follower follower(right_angle(20.0), {}, 0.1);
  while (follower.command_mm < 45.0) {
    follower.step(20.0);
    const double along_mm = follower.state.speed_mm_s * follower.lag_s() -
                            (follower.command_mm - follower.state.position_mm);
    EXPECT_GE(along_mm, -0.1 - 1e-3) << "at " << follower.command_mm << " mm";
    EXPECT_LE(along_mm, 1e-9) << "it is never ahead of the servo";
  }
}

// In the air no corner counts.
TEST(ToolPoint, KeepsItsSpeedRoundCornersOfRapids) {
  auto path = right_angle(20.0);
  for (auto& segment : path) {
    segment.motion = kernel::signal::Motion::rapid;
  }
  Follower follower(std::move(path));
  follower.run(20.0, 0.5);
  while (follower.command_mm < 30.0) {
    follower.step(20.0);
    EXPECT_NEAR(follower.state.speed_mm_s, 20.0, 1e-6);
  }
}

// The flank of the screw that carries changes with the direction of travel, not at rest.
TEST(ToolPoint, AddsHalfOfTheBacklashInTheDirectionOfTravel) {
  LookAhead ahead(test::mill().axes, kernel::machine::kUnlimited, 3.0);
  auto path = PathMaker({0, 0, 0}, 10.0).line_to({10, 0, 0}).line_to({0, 0, 0}).path();
  for (int i = 0; i < 60; ++i) {
    ahead.update(path, 0, 0.0, 0.0, 60.0);
  }
  ToolPoint point({.half_backlash_mm = {0.002, 0.0, 0.0}, .most_behind_mm = 1.0});
  point.set_model(std::array{AxisModel{}, AxisModel{}, AxisModel{}});
  auto state = point.at(ahead, 0.0, 0.0);
  EXPECT_EQ(state.command_mm[0], 0.0) << "the flank is not known before it moves";
  double at = 0.0;
  const auto added = [&](double to) {
    while (at < to) {
      point.advance(ahead, at, std::min(to, at + 0.01), kCycle_s, state);
      at = std::min(to, at + 0.01);
    }
    for (int i = 0; i < 2000; ++i) {
      point.advance(ahead, at, at, kCycle_s, state);
    }
    return state.command_mm[0] - (at <= 10.0 ? at : 20.0 - at);
  };
  EXPECT_NEAR(added(5.0), 0.002, 1e-9) << "kept at rest";
  EXPECT_NEAR(added(15.0), -0.002, 1e-9);
}

}  // namespace
}  // namespace steadyrest::contour::online
