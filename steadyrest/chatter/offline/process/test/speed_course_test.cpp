// SPDX-License-Identifier: Apache-2.0
// A course of ramps, worked out by hand: θ = (n₀ + n₁)/2·t turns on each, Ω² linear in the angle.
#include <cmath>
#include <numbers>
#include <vector>

#include <gtest/gtest.h>

#include <steadyrest/chatter/offline/process/speed_profile.hpp>

namespace steadyrest::chatter::offline {
namespace {

constexpr double kTurned_rad = 2.0 * std::numbers::pi;

/// 30 turns up from 10 to 20 rev/s, 10 held, 30 down again: 4.5 s.
const std::vector<SpeedRamp> kHill = {{2.0, 10.0, 20.0}, {0.5, 20.0, 20.0}, {2.0, 20.0, 10.0}};

TEST(CourseOfRamps, TurnsByTheMeanSpeedOfEachRamp) {
  EXPECT_NEAR(SpeedProfile::angle_rad(kHill), 70.0 * kTurned_rad, 1e-9);
  const SpeedProfile hill(kHill, SpeedProfile::angle_rad(kHill));
  EXPECT_NEAR(hill.mean_rad_s(), 70.0 / 4.5 * kTurned_rad, 1e-9);
  EXPECT_NEAR(hill.slowest_rad_s(), 10.0 * kTurned_rad, 1e-9);
  EXPECT_FALSE(hill.constant());
}

// After 1 s the first ramp is at 15 rev/s and has turned 12.5 times.
TEST(CourseOfRamps, HasTheSpeedAndTimeOfAnEvenAcceleration) {
  const SpeedProfile hill(kHill, 70.0 * kTurned_rad);
  EXPECT_NEAR(hill.speed_rad_s(12.5 * kTurned_rad), 15.0 * kTurned_rad, 1e-9);
  EXPECT_NEAR(hill.time_s(12.5 * kTurned_rad), 1.0, 1e-12);
  EXPECT_NEAR(hill.speed_rad_s(35.0 * kTurned_rad), 20.0 * kTurned_rad, 1e-9);
  EXPECT_NEAR(hill.time_s(35.0 * kTurned_rad), 2.25, 1e-12);
  EXPECT_NEAR(hill.speed_rad_s(57.5 * kTurned_rad), 15.0 * kTurned_rad, 1e-9);
  EXPECT_NEAR(hill.time_s(57.5 * kTurned_rad), 3.5, 1e-12);
  EXPECT_NEAR(hill.time_s((3 * 70.0 + 12.5) * kTurned_rad), 3 * 4.5 + 1.0, 1e-11) << "and again";
}

// The speeds are the machine's own: only the times change.
TEST(CourseOfRamps, StretchedToMoreTurnsTakesLongerAtTheSameSpeeds) {
  const SpeedProfile hill(kHill, 77.0 * kTurned_rad);
  EXPECT_NEAR(hill.time_s(77.0 * kTurned_rad), 1.1 * 4.5, 1e-11);
  EXPECT_NEAR(hill.speed_rad_s(1.1 * 12.5 * kTurned_rad), 15.0 * kTurned_rad, 1e-9);
  EXPECT_NEAR(hill.time_s(1.1 * 12.5 * kTurned_rad), 1.1, 1e-12);
  ASSERT_EQ(hill.corners_rad().size(), 3U);
  EXPECT_EQ(hill.corners_rad()[0], 0.0);
  EXPECT_NEAR(hill.corners_rad()[1], 33.0 * kTurned_rad, 1e-9);
  EXPECT_NEAR(hill.corners_rad()[2], 44.0 * kTurned_rad, 1e-9);
}

TEST(CourseOfRamps, HasCornersUpToSixtyFourRamps) {
  const std::vector<SpeedRamp> stairs(64, {0.1, 10.0, 10.0});
  EXPECT_EQ(SpeedProfile(stairs, 64.0 * kTurned_rad).corners_rad().size(), 64U);
  const std::vector<SpeedRamp> more(65, {0.1, 10.0, 10.0});
  EXPECT_TRUE(SpeedProfile(more, 65.0 * kTurned_rad).corners_rad().empty());
}

}  // namespace
}  // namespace steadyrest::chatter::offline
