// SPDX-License-Identifier: Apache-2.0
#include <cmath>
#include <numbers>

#include <gtest/gtest.h>

#include <steadyrest/nc/plan/path/blend.hpp>

namespace steadyrest::nc::plan {
namespace {

constexpr double kPi = std::numbers::pi;
const double kShare = std::sqrt(0.75);
constexpr PlaneLimits kPlane{.acceleration_mm_s2 = 2000.0, .speed_mm_s = 200.0, .jerk_mm_s3 = 1e9};

/// A line of 10 mm at 50 mm/s.
BlendSide line(const kernel::signal::Point& along) {
  BlendSide side;
  side.length_mm = side.nominal_mm = 10.0;
  side.speed_mm_s = 50.0;
  side.ramp_mm_s2 = 2000.0;
  side.bend = along;
  return side;
}

TEST(Blend, ATightToleranceMakesTheRadiusAndTheRadiusTheSpeed) {
  BlendSide before = line({1, 0, 0});
  BlendSide after = line({0, 1, 0});
  before.program_tolerance_mm = after.program_tolerance_mm = 0.1;
  const BlendArc arc = blend_arc(before, after, kPi / 2, kPlane, kShare);
  const double radius = 0.1 / (std::sqrt(2.0) - 1.0);
  EXPECT_NEAR(arc.radius_mm, radius, 1e-12);
  EXPECT_NEAR(arc.speed_mm_s, std::sqrt(kShare * 2000.0 * radius), 1e-9);
  EXPECT_NEAR(arc.tolerance_mm, 0.1, 1e-15);
}

// R is what the turn takes at half the acceleration: v·t = R·φ, t = v/(a/2).
TEST(Blend, WithRoomTheRadiusIsWhatTheSpeedNeeds) {
  const BlendArc arc = blend_arc(line({1, 0, 0}), line({0, 1, 0}), kPi / 2, kPlane, kShare);
  EXPECT_NEAR(arc.radius_mm, 50.0 * 50.0 / 1000.0 / (kPi / 2), 1e-12);
  EXPECT_EQ(arc.speed_mm_s, 50.0);
  EXPECT_EQ(arc.tolerance_mm, 2.5);  // a quarter of the shorter side
}

TEST(Blend, AnArcGivesTwoThirdsBeforeAndOneThirdAfter) {
  BlendSide arc = line({1, 0, 0});
  arc.arc = true;
  arc.radius_mm = 6.0;
  arc.sweep_rad = 1.2;
  const BlendSide straight = line({0, 1, 0});
  EXPECT_NEAR(blend_arc(arc, straight, 0.1, kPlane, kShare).room_before_mm, 0.8 * 6.0, 1e-12);
  EXPECT_NEAR(blend_arc(straight, arc, 0.1, kPlane, kShare).room_after_mm, 0.4 * 6.0, 1e-12);
  // Taken by its chord, an arc that bends with the corner makes it sharper and leaves less room.
  BlendSide convex = arc;
  convex.convex = true;
  EXPECT_LT(blend_arc(straight, convex, 0.1, kPlane, kShare).radius_mm,
            blend_arc(straight, arc, 0.1, kPlane, kShare).radius_mm);
}

TEST(Blend, RampsThatOverlapInLineLoseNothing) {
  const Overlap both = overlap(line({1, 0, 0}), line({1, 0, 0}), 0.5, 1.0);
  EXPECT_NEAR(both.before_mm_s, 50.0, 1e-9);
  EXPECT_NEAR(both.kept_mm_s, 50.0, 1e-9);
}

TEST(Blend, RampsThatOverlapAcrossKeepTheSineOfHalfTheAngle) {
  BlendSide before = line({1, 0, 0});
  const BlendSide after = line({0, 1, 0});
  EXPECT_NEAR(overlap(before, after, 0.5, 1.0).kept_mm_s, 50.0 / std::sqrt(2.0), 1e-9);
  before.program_tolerance_mm = 0.01;
  const double slower = 2.0 * std::sqrt(1000.0 * 0.01 * std::sqrt(2.0));
  EXPECT_NEAR(overlap(before, after, 0.5, 1.0).after_mm_s, slower, 1e-9);
}

// √(A·L): up and down again within the length.
TEST(Blend, AShortSideIsTakenAsFastAsItsLengthPermits) {
  BlendSide before = line({1, 0, 0});
  before.length_mm = 0.4;
  EXPECT_NEAR(overlap(before, line({1, 0, 0}), 0.5, 1.0).before_mm_s, 20.0, 1e-9);
}

}  // namespace
}  // namespace steadyrest::nc::plan
