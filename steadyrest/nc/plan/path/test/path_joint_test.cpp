// SPDX-License-Identifier: Apache-2.0
// Joints under LinuxCNC's law, in closed form; whole programs against LinuxCNC itself are in
// tests/linuxcnc/time.
#include <cmath>
#include <numbers>

#include <gtest/gtest.h>

#include <steadyrest/nc/plan/test/moves.hpp>

namespace steadyrest::nc::plan {
namespace {

using interpret::PathMode;
using kernel::signal::Geometry;
using test::plan_of;
using test::Program;

constexpr double kDegree = std::numbers::pi / 180.0;

/// 2000 mm/s² and 200 mm/s, 1 ms, a tenth of the acceleration in a corner.
kernel::machine::Machine linuxcnc_mill() {
  auto machine = test::mill();
  for (auto& axis : machine.axes) {
    axis.max_speed_au_s = 200.0;
    axis.max_acceleration_au_s2 = 2000.0;
  }
  machine.feed_override.max_ratio = 1.0;
  auto& c = machine.control;
  c.junction_share = 0.1;
  c.junction_deviation_mm = 0.0;
  c.corner_tolerance_mm = 10.0;
  c.corner_acceleration_share = 0.5;
  c.centripetal_share = std::sqrt(0.75);
  c.min_block_cycles = 1.02;
  c.blend_gap_cycles = 4.0;
  return machine;
}

/// Two lines of 10 mm at 12.5 mm/s that turn by `turn_rad`.
Program corner(double turn_rad, PathMode mode) {
  Program p;
  p.mode = mode;
  p.line(10, 0, 12.5);
  p.line(10 + 10 * std::cos(turn_rad), 10 * std::sin(turn_rad), 12.5);
  return p;
}

// At 12.5 mm/s, (v/T + a)/A = 7.25: a tenth is 0.79°.
TEST(PathJoint, TheExactPathStopsAtAKinkBeyondItsShare) {
  const auto machine = linuxcnc_mill();
  const auto sharp = plan_of(machine, corner(1.0 * kDegree, PathMode::exact_path));
  EXPECT_EQ(sharp.plans[0].exit_speed_limit_mm_s, 0.0);
  EXPECT_NEAR(sharp.plans[0].acceleration_mm_s2, 0.9 * 2000.0, 1e-9);
  const auto flat = plan_of(machine, corner(0.7 * kDegree, PathMode::exact_path));
  EXPECT_GE(flat.plans[0].exit_speed_limit_mm_s, 12.5);
  const double kink = 7.25 * std::sin(0.7 * kDegree);
  EXPECT_NEAR(flat.plans[0].acceleration_mm_s2, (1.0 - kink) * 2000.0, 0.01);
}

TEST(PathJoint, BesideAnArcAKinkCountsTwice) {
  Program p;
  p.line(10, 0, 12.5);
  // 0.5° to the left, then round.
  const double c = std::cos(0.5 * kDegree);
  const double s = std::sin(0.5 * kDegree);
  p.arc(10 - 5 * s + 5 * c, 5 * c + 5 * s, 10 - 5 * s, 5 * c, 1, 12.5);
  EXPECT_EQ(plan_of(linuxcnc_mill(), p).plans[0].exit_speed_limit_mm_s, 0.0);
}

TEST(PathJoint, AHelixThatChangesItsSlopeHasAKink) {
  const auto exit_after = [](double second_rise) {
    Program p;
    p.at = {10, 0, 0};
    p.arc(0, 10, 0, 0, 1, 40.0, 0.0);
    p.arc(-10, 0, 0, 0, 1, 40.0, second_rise);
    return plan_of(linuxcnc_mill(), p).plans[0].exit_speed_limit_mm_s;
  };
  EXPECT_GE(exit_after(0.0), 40.0);
  EXPECT_GE(exit_after(-0.03), 40.0);  // 0.11°: 2·(40/0.001 + 2000)/2000·0.0019 = 0.08
  EXPECT_EQ(exit_after(-0.06), 0.0);
}

TEST(PathJoint, ContinuousModeRoundsWhatIsBeyondAndLeavesTheRestSharp) {
  const auto machine = linuxcnc_mill();
  const auto sharp = plan_of(machine, corner(1.0 * kDegree, PathMode::continuous));
  ASSERT_EQ(sharp.segments.size(), 3U);
  EXPECT_EQ(sharp.segments[1].geometry, Geometry::arc);
  EXPECT_EQ(plan_of(machine, corner(0.7 * kDegree, PathMode::continuous)).segments.size(), 2U);
}

// 0.1·A·v/((v/T + a)·|Δt|): what LinuxCNC gives a corner that it neither rounds nor stops at.
TEST(PathJoint, TheExactPathWithAToleranceGoesOnAtTheThreshold) {
  Program p = corner(90.0 * kDegree, PathMode::exact_path);
  for (auto& move : p.moves) {
    move.path_tolerance_mm = 0.01;
  }
  const auto path = plan_of(linuxcnc_mill(), p);
  ASSERT_EQ(path.segments.size(), 2U);
  EXPECT_NEAR(path.plans[0].exit_speed_limit_mm_s, 0.1 * 12.5 / 7.25, 1e-9);
}

// The text's five decimals make the radii of its arcs differ a little: still circles.
TEST(PathJoint, RoundedCoordinatesDoNotKeepAnArcFromBeingRounded) {
  Program p;
  p.mode = PathMode::continuous;
  p.line(5, 0, 33.0);
  p.arc(10.19091, 3.00906, 4.98953, 5.99999, 1, 33.0);
  p.line(10.19091, 9.0, 33.0);
  const auto path = plan_of(linuxcnc_mill(), p);
  ASSERT_EQ(path.segments.size(), 4U);
  const auto& arc = path.segments[1];
  EXPECT_NEAR(arc.radius_end_mm, std::hypot(arc.end_mm[0] - 4.98953, arc.end_mm[1] - 5.99999),
              1e-12);
  EXPECT_EQ(path.segments[2].geometry, Geometry::arc);
  EXPECT_EQ(path.segments[2].start_mm, arc.end_mm);
  EXPECT_LT(arc.sweep_rad, std::numbers::pi / 3);
}

// LinuxCNC enters the last piece as if it had to stop half way: √(A·L).
TEST(PathJoint, TheLastPieceIsEnteredSlowly) {
  Program p;
  p.line(10, 0, 100.0);
  p.line(10.2, 0, 100.0);
  EXPECT_NEAR(plan_of(linuxcnc_mill(), p).plans[0].exit_speed_limit_mm_s, std::sqrt(2000.0 * 0.2),
              1e-9);
}

TEST(PathJoint, AReversalIsAStopWithoutAnyLoss) {
  for (const auto mode : {PathMode::exact_path, PathMode::continuous}) {
    Program p;
    p.mode = mode;
    p.line(10, 0, 20.0);
    p.line(0, 0.1, 20.0);
    p.line(-10, 0.1, 20.0);
    const auto path = plan_of(linuxcnc_mill(), p);
    EXPECT_EQ(path.plans[0].exit_speed_limit_mm_s, 0.0);
    EXPECT_NEAR(path.plans[0].acceleration_mm_s2, 2000.0, 1e-9);
  }
}

TEST(PathJoint, AMoveAfterRestBeginsAtRest) {
  Program p;
  p.line(10, 0, 20.0);
  p.line(20, 0, 20.0).after_rest = true;
  const auto path = plan_of(linuxcnc_mill(), p);
  EXPECT_EQ(path.plans[0].exit_speed_limit_mm_s, 0.0);
  EXPECT_TRUE(path.events.empty());
}

// LinuxCNC 2.10: between lines the exact path goes on at the threshold; beside an arc it stops.
TEST(PathJoint, ThePlannerWithLimitedJerkStopsOnlyBesideArcs) {
  auto machine = linuxcnc_mill();
  machine.control.planner = kernel::machine::LinuxCncPlanner::s_curve;
  const Program lines = corner(90.0 * kDegree, PathMode::exact_path);
  EXPECT_NEAR(plan_of(machine, lines).plans[0].exit_speed_limit_mm_s, 0.1 * 12.5 / 7.25, 1e-9);
  Program p;
  p.line(10, 0, 12.5);
  p.arc(15, 5, 15, 0, -1, 12.5);
  EXPECT_EQ(plan_of(machine, p).plans[0].exit_speed_limit_mm_s, 0.0);
}

TEST(PathJoint, ABlockTakesItsTimeWhateverItsFeed) {
  auto machine = test::mill();
  Program p;
  p.line(0.1, 0, 50.0);
  machine.control.block_time_s = 0.004;
  EXPECT_NEAR(plan_of(machine, p).plans[0].speed_limit_mm_s, 25.0, 1e-9);
  // Not known: the worst; on LinuxCNC its periods say it.
  machine.control.block_time_s = kernel::machine::kUnlimited;
  EXPECT_GT(plan_of(machine, p).plans[0].speed_limit_mm_s, 50.0);
  machine.control.dialect = kernel::machine::Dialect::sinumerik;
  EXPECT_NEAR(plan_of(machine, p).plans[0].speed_limit_mm_s, 5.0, 1e-9);
}

// The lag that a ramp of 2000 mm/s² leaves at k = 50 1/s is 0.8 mm; it decays to 0.01 mm in
// ln(80)/50 s.
TEST(PathJoint, AnExactStopWaitsForTheAxes) {
  auto machine = test::mill();
  machine.axes[0].servo_gain_1_s = 50.0;
  machine.axes[0].max_acceleration_au_s2 = 2000.0;
  machine.control.exact_stop_mm = 0.01;
  Program p;
  p.mode = PathMode::exact_stop;
  p.line(10, 0, 50.0);
  p.line(10, 10, 50.0);
  const auto path = plan_of(machine, p);
  ASSERT_EQ(path.events.size(), 1U);
  EXPECT_EQ(path.events[0].kind, PathEventKind::dwell);
  EXPECT_EQ(path.events[0].segment, 1U);
  EXPECT_EQ(path.events[0].line, 1U);
  EXPECT_NEAR(path.events[0].value, std::log(80.0) / 50.0, 1e-9);
  machine.axes[0].feed_forward = 1.0;
  EXPECT_TRUE(plan_of(machine, p).events.empty());
}

}  // namespace
}  // namespace steadyrest::nc::plan
