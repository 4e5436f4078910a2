// SPDX-License-Identifier: Apache-2.0
// The limits of a path against the motion of every axis, all along the path.
#include <algorithm>
#include <cmath>
#include <numbers>
#include <vector>

#include <gtest/gtest.h>
#include <rapidcheck.h>
#include <rapidcheck/gtest.h>

#include <steadyrest/math/geometry/segment.hpp>
#include <steadyrest/math/geometry/vector.hpp>
#include <steadyrest/nc/plan/path/limits.hpp>

namespace steadyrest::nc::plan {
namespace {

namespace geometry = math::geometry;
using kernel::signal::AxisValues;
using kernel::signal::Geometry;
using kernel::signal::PathSegment;
using kernel::signal::Point;

double random_number(double low, double high) {
  return low + (high - low) * (*rc::gen::inRange(0, 10'001)) / 10'000.0;
}

/// Four axes, the last one rotary, no two alike.
std::vector<kernel::machine::Axis> random_axes() {
  std::vector<kernel::machine::Axis> axes(4);
  for (auto& axis : axes) {
    axis.max_speed_au_s = random_number(50.0, 400.0);
    axis.max_acceleration_au_s2 = random_number(300.0, 5000.0);
  }
  axes[3].rotary = true;
  axes[3].max_speed_au_s = random_number(0.5, 5.0);
  axes[3].max_acceleration_au_s2 = random_number(2.0, 50.0);
  return axes;
}

Point random_unit() {
  const double height = random_number(-1.0, 1.0);
  const double angle = random_number(0.0, 6.28);
  const double flat = std::sqrt(1.0 - height * height);
  return {flat * std::cos(angle), flat * std::sin(angle), height};
}

RC_GTEST_PROP(PathLimitsLaw, OnALineOneAxisIsAtItsLimitAndNoneBeyond, ()) {
  const auto axes = random_axes();
  const PathLimits limits(axes, {});
  const Point unit = random_unit();
  AxisValues direction{unit[0], unit[1], unit[2], random_number(-0.1, 0.1)};
  const SpeedLimits line = limits.line(direction);
  double speed = 0.0;
  double acceleration = 0.0;
  for (std::size_t i = 0; i < 4; ++i) {
    const double share = std::abs(direction[i]);
    speed = std::max(speed, line.speed_mm_s * share / axes[i].max_speed_au_s);
    acceleration =
        std::max(acceleration, line.acceleration_mm_s2 * share / axes[i].max_acceleration_au_s2);
  }
  RC_ASSERT(std::abs(speed - 1.0) <= 1e-12);
  RC_ASSERT(std::abs(acceleration - 1.0) <= 1e-12);
}

/// Shares of the limits that the worst axis uses anywhere on the arc, at v and ±a along the path.
struct Use {
  double speed = 0.0;
  double acceleration = 0.0;
};
Use use_of(const PathSegment& arc, const std::vector<kernel::machine::Axis>& axes,
           const SpeedLimits& at) {
  Use use;
  for (int n = 0; n <= 400; ++n) {
    const double u = n / 400.0;
    const geometry::Station here = geometry::station_at(arc, u);
    for (std::size_t i = 0; i < 3; ++i) {
      const double v = at.speed_mm_s * std::abs(here.tangent[i]);
      const double along = at.acceleration_mm_s2 * std::abs(here.tangent[i]);
      const double across = at.speed_mm_s * at.speed_mm_s * std::abs(here.curvature_1_mm[i]);
      use.speed = std::max(use.speed, v / axes[i].max_speed_au_s);
      use.acceleration =
          std::max(use.acceleration, (along + across) / axes[i].max_acceleration_au_s2);
    }
  }
  return use;
}

PathSegment random_circle(double radius_mm) {
  PathSegment arc;
  arc.geometry = Geometry::arc;
  arc.axis = random_unit();
  const Point away = std::abs(arc.axis[0]) < 0.9 ? Point{1, 0, 0} : Point{0, 1, 0};
  arc.start_mm = geometry::scale(geometry::unit(geometry::cross(arc.axis, away)), radius_mm);
  arc.radius_mm = arc.radius_end_mm = radius_mm;
  arc.sweep_rad = 2.0 * std::numbers::pi;
  arc.end_mm = geometry::point_at(arc, 1.0);
  arc.length_mm = geometry::arc_length_mm(arc);
  return arc;
}

// All round a circle in any plane no axis exceeds its limits, and the binding limit is reached: an
// axis' speed, or the share of the acceleration across the path.
RC_GTEST_PROP(PathLimitsLaw, OnACircleNoAxisIsBeyondItsLimits, ()) {
  const auto axes = random_axes();
  const kernel::machine::Control control;
  const PathLimits limits(axes, control);
  const double radius_mm = random_number(0.2, 200.0);
  const PathSegment arc = random_circle(radius_mm);
  const SpeedLimits at = limits.arc(arc);
  const Use use = use_of(arc, axes, at);
  RC_ASSERT(use.speed <= 1.0 + 1e-9);
  RC_ASSERT(use.acceleration <= 1.0 + 1e-9);
  const double plane = limits.plane(arc.axis).acceleration_mm_s2;
  const double across = at.speed_mm_s * at.speed_mm_s / radius_mm;
  const bool by_speed = use.speed >= 1.0 - 1e-3;
  const bool by_turn = std::abs(across - control.centripetal_share * plane) <= 1e-9 * plane;
  RC_ASSERT(by_speed || by_turn);
  RC_ASSERT(std::abs(std::hypot(across, at.acceleration_mm_s2) - plane) <= 1e-9 * plane);
}

// A circle's own jerk is v³/R²: with A/J as short as the limits allow it binds before the
// acceleration does.
RC_GTEST_PROP(PathLimitsLaw, ACircleKeepsTheJerkOfItsPlane, ()) {
  auto axes = random_axes();
  for (auto& axis : axes) {
    axis.max_jerk_au_s3 = random_number(1e3, 1e5);
  }
  const PathLimits limits(axes, {});
  const double radius_mm = random_number(0.2, 50.0);
  const PathSegment arc = random_circle(radius_mm);
  const double v = limits.arc(arc).speed_mm_s;
  for (std::size_t i = 0; i < 3; ++i) {
    const double share = std::sqrt(1.0 - arc.axis[i] * arc.axis[i]);
    RC_ASSERT(v * v * v / (radius_mm * radius_mm) * share <= axes[i].max_jerk_au_s3 * (1 + 1e-9));
  }
}

// Helices and spirals about the machine's axes, which is what G17, G18 and G19 make.
RC_GTEST_PROP(PathLimitsLaw, OnAHelixOrSpiralNoAxisIsBeyondItsLimits, ()) {
  const auto axes = random_axes();
  const PathLimits limits(axes, {});
  PathSegment arc;
  arc.geometry = Geometry::arc;
  const auto normal = *rc::gen::inRange<std::size_t>(0, 3);
  arc.axis[normal] = *rc::gen::element(-1.0, 1.0);
  arc.radius_mm = random_number(0.5, 50.0);
  arc.radius_end_mm = *rc::gen::arbitrary<bool>() ? arc.radius_mm : random_number(0.5, 50.0);
  arc.start_mm[(normal + 1) % 3] = arc.radius_mm;
  arc.sweep_rad = random_number(0.2, 12.0);
  arc.rise_mm = random_number(-20.0, 20.0);
  arc.end_mm = geometry::point_at(arc, 1.0);
  arc.length_mm = geometry::arc_length_mm(arc);
  const SpeedLimits at = limits.arc(arc);
  const Use use = use_of(arc, axes, {at.speed_mm_s, 0.0});
  RC_ASSERT(use.speed <= 1.0 + 1e-9);
  RC_ASSERT(at.speed_mm_s > 0.0);
  RC_ASSERT(at.acceleration_mm_s2 > 0.0);
  // Where the radius does not change, the turn's acceleration is known exactly.
  if (arc.radius_end_mm == arc.radius_mm) {
    RC_ASSERT(use_of(arc, axes, at).acceleration <= 1.0 + 1e-9);
  }
}

// Without a deviation an axis jumps by at most one period of its acceleration; where no curve is
// approximated (long lines) one axis jumps by exactly that. A kink is the same share at any speed,
// and that of the ramp after it.
RC_GTEST_PROP(PathLimitsLaw, AtACornerNoAxisJumpsByMoreThanItsPeriod, ()) {
  const auto axes = random_axes();
  kernel::machine::Control control;
  control.junction_deviation_mm = 0.0;
  const PathLimits limits(axes, control);
  const Point in = random_unit();
  const Point out = random_unit();
  const AxisValues before{in[0], in[1], in[2], random_number(-0.01, 0.01)};
  const AxisValues after{out[0], out[1], out[2], random_number(-0.01, 0.01)};
  const double v = limits.junction_mm_s(before, after, 1e9, 1e9);
  RC_PRE(v < 1e6);  // else it is no corner
  double use = 0.0;
  for (std::size_t i = 0; i < 4; ++i) {
    use = std::max(use, v * std::abs(after[i] - before[i]) /
                            (axes[i].max_acceleration_au_s2 * control.interpolator_period_s));
  }
  RC_ASSERT(std::abs(use - 1.0) <= 1e-9);
  const double ramp = random_number(0.0, 5000.0);
  const double with_ramp = 1.0 + ramp * control.interpolator_period_s / v;
  RC_ASSERT(std::abs(limits.kink(before, after, v, ramp) / with_ramp - 1.0) <= 1e-9);
  RC_ASSERT(std::abs(limits.kink(before, after, 0.5 * v, 0.0) - 0.5) <= 1e-9);
}

TEST(PathLimitsLaw, BriskHasNoJerkLimit) {
  std::vector<kernel::machine::Axis> axes(3);
  axes[0].max_jerk_au_s3 = 1e4;
  kernel::machine::Control control;
  control.max_path_jerk_mm_s3 = 1e4;
  EXPECT_GT(PathLimits(axes, control).jerk_time_s(), 0.0);
  control.acceleration_mode = kernel::machine::AccelerationMode::brisk;
  EXPECT_EQ(PathLimits(axes, control).jerk_time_s(), 0.0);
}

// The averaging time is the longest A/J of the axes and of the path (√3 times the largest linear
// axis along a space diagonal, or the path's own limit).
TEST(PathLimitsLaw, TheJerkTimeIsTheLongestOfAll) {
  std::vector<kernel::machine::Axis> axes(4);
  axes[3].rotary = true;
  axes[3].max_acceleration_au_s2 = 1e6;
  kernel::machine::Control control;
  EXPECT_EQ(PathLimits(axes, control).jerk_time_s(), 0.0);
  axes[1].max_jerk_au_s3 = 40'000.0;
  EXPECT_NEAR(PathLimits(axes, control).jerk_time_s(), 2000.0 / 40'000.0, 1e-15);
  control.max_path_jerk_mm_s3 = 20'000.0;
  EXPECT_NEAR(PathLimits(axes, control).jerk_time_s(), std::sqrt(3.0) * 2000.0 / 20'000.0, 1e-12);
  control.max_path_acceleration_mm_s2 = 1500.0;
  EXPECT_NEAR(PathLimits(axes, control).jerk_time_s(), 1500.0 / 20'000.0, 1e-15);
  control.max_path_acceleration_mm_s2 = 500.0;
  EXPECT_NEAR(PathLimits(axes, control).jerk_time_s(), 0.05, 1e-15) << "an axis again";
}

// rad/s² is no mm/s²: however slow a rotary axis, it does not enter the law of lengths in space.
TEST(PathLimitsLaw, ARotaryAxisThatBarelyTurnsSlowsNoCorner) {
  std::vector<kernel::machine::Axis> axes(4);
  axes[3].rotary = true;
  axes[3].max_acceleration_au_s2 = 10.0;
  kernel::machine::Control control;
  control.junction_deviation_mm = 0.01;
  const PathLimits limits(axes, control);
  const double still = limits.junction_mm_s({1.0, 0.0, 0.0, 0.0}, {0.0, 1.0, 0.0, 0.0}, 10.0, 10.0);
  const double turning =
      limits.junction_mm_s({1.0, 0.0, 0.0, 0.0}, {0.0, 1.0, 0.0, 1e-6}, 10.0, 10.0);
  EXPECT_GT(still, 0.0);
  EXPECT_DOUBLE_EQ(turning, still);
}

}  // namespace
}  // namespace steadyrest::nc::plan
