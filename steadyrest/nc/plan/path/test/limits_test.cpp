// SPDX-License-Identifier: Apache-2.0
#include <cmath>
#include <numbers>

#include <gtest/gtest.h>

#include <steadyrest/nc/plan/path/limits.hpp>
#include <steadyrest/nc/plan/test/moves.hpp>

namespace steadyrest::nc::plan {
namespace {

using kernel::signal::AxisValues;

PathLimits limits_of(const kernel::machine::Machine& machine) {
  return {machine.axes, machine.control};
}

TEST(PathLimits, ADiagonalUsesBothAxes) {
  // Along 45° each axis has 1/√2 of the path's speed, so the path may have √2 of the axis' limit.
  const PathLimits limits = limits_of(test::mill());
  const double r = std::numbers::sqrt2;
  const auto l = limits.line(AxisValues{1 / r, 1 / r});
  EXPECT_NEAR(l.speed_mm_s, 200.0 * r, 1e-9);
  EXPECT_NEAR(l.acceleration_mm_s2, 2000.0 * r, 1e-9);
}

TEST(PathLimits, TheSlowestAxisDecides) {
  auto m = test::mill();
  m.axes[2].max_speed_au_s = 20.0;
  m.axes[2].max_acceleration_au_s2 = 100.0;
  const PathLimits limits = limits_of(m);
  // Z takes 0.8 of the path: 20/0.8 = 25 mm/s and 100/0.8 = 125 mm/s².
  const auto l = limits.line(AxisValues{0.6, 0.0, 0.8});
  EXPECT_NEAR(l.speed_mm_s, 25.0, 1e-9);
  EXPECT_NEAR(l.acceleration_mm_s2, 125.0, 1e-9);
}

TEST(PathLimits, ACircleKeepsItsCentripetalAcceleration) {
  const auto m = test::mill();
  test::Program p;
  // R = 1 mm and no axis limits the speed: v²/R must be exactly κ_n·A, and the tangential rest by
  // Pythagoras.
  p.at = {1, 0, 0};
  p.arc(1, 0, 0, 0, 1, 1000.0);
  const auto path = test::plan_of(m, p);
  const double v = path.plans[0].speed_limit_mm_s;
  EXPECT_NEAR(v * v / 1.0, 0.866 * 2000.0, 1e-6);
  EXPECT_NEAR(path.plans[0].acceleration_mm_s2, 2000.0 * std::sqrt(1 - 0.866 * 0.866), 1e-6);
}

TEST(PathLimits, ARightAngleWithoutDeviationJumpsByOnePeriodOfAcceleration) {
  // δ = 0 leaves only the jump: Δt_x = Δt_y = 1, so v = A·T = 2000·0.001.
  auto m = test::mill();
  m.control.junction_deviation_mm = 0.0;
  const PathLimits limits = limits_of(m);
  EXPECT_NEAR(limits.junction_mm_s({1, 0, 0}, {0, 1, 0}, 100, 100), 2000.0 * 0.001, 1e-12);
}

TEST(PathLimits, TheDeviationLawAtARightAngle) {
  auto m = test::mill();
  m.control.junction_deviation_mm = 0.01;
  const PathLimits limits = limits_of(m);
  // The legs enclose 90°: β = 45°.
  const double s = std::sqrt(0.5);
  EXPECT_NEAR(limits.junction_mm_s({1, 0, 0}, {0, 1, 0}, 100, 100),
              std::sqrt(2000.0 * 0.01 * s / (1 - s)), 1e-9);
}

TEST(PathLimits, FacetsOfACurveKeepItsCentripetalLimit) {
  const PathLimits limits = limits_of(test::mill());
  // Facets of R·turn on a circle of R = 5 mm: v² = A·R up to the cosine of half the turn.
  const double radius = 5.0;
  const double turn = 0.01;
  const double v = limits.junction_mm_s({1, 0, 0}, {std::cos(turn), std::sin(turn), 0},
                                        radius * turn, radius * turn);
  EXPECT_NEAR(v, std::sqrt(2000.0 * radius), 1e-3 * v);
}

TEST(PathLimits, AReversalOnTheSpotNearlyStops) {
  const PathLimits limits = limits_of(test::mill());
  // A reversal changes the velocity by 2·v, so half of A·T is left: 1 mm/s.
  EXPECT_LE(limits.junction_mm_s({1, 0, 0}, {-1, 0, 0}, 100, 100), 1.0 + 1e-9);
}

TEST(PathLimits, NoTurnIsNoLimit) {
  const PathLimits limits = limits_of(test::mill());
  // Catches a division by a zero change of direction.
  EXPECT_EQ(limits.junction_mm_s({1, 0, 0}, {1, 0, 0}, 1, 1), kernel::machine::kUnlimited);
}

}  // namespace
}  // namespace steadyrest::nc::plan
