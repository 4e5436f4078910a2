// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <cmath>

#include <gtest/gtest.h>

#include <steadyrest/kernel/offset/limited_follower.hpp>

namespace steadyrest::kernel::offset {
namespace {

constexpr double kStep_s = 0.001;
constexpr double kMost = 400.0;

// A·ω² of these sines is below the limit, and A·ω below √(2·400·0.05·S), from which it can brake
// within a twentieth of S.
TEST(LimitedFollower, FollowsWithinOneStepWhatItCanDo) {
  for (const double omega : {1.0, 2.0, 3.0, 4.0, 5.0, 6.0}) {
    LimitedFollower follower;
    double worst = 0.0;
    for (int i = 1; i < 5000; ++i) {
      const double next = 0.5 * std::sin(omega * kStep_s * i);
      follower.follow(next, kMost, kStep_s);
      worst = i > 1500 ? std::max(worst, std::abs(follower.at_mm - next)) : 0.0;
    }
    EXPECT_LE(worst, 1.01 * 0.5 * omega * kStep_s) << omega;
  }
}

// The shortest way from rest to rest over J: 2·√(J/a).
TEST(LimitedFollower, TakesAJumpInTheShortestTimeAndHardlyOvershoots) {
  for (const double jump : {0.01, 0.5, -2.0}) {
    LimitedFollower follower;
    double before = 0.0;
    double most = 0.0;
    double farthest = 0.0;
    int arrived = 0;
    for (int i = 1; i < 1000; ++i) {
      const double speed = follower.speed_mm_s;
      follower.follow(jump, kMost, kStep_s);
      most = std::max(most, std::abs(follower.speed_mm_s - speed) / kStep_s);
      farthest = std::max(farthest, follower.at_mm / jump);
      arrived = std::abs(follower.at_mm - jump) > 0.05 * std::abs(jump) ? i : arrived;
      before = follower.at_mm;
    }
    EXPECT_LE(most, kMost * (1.0 + 1e-9));
    EXPECT_LE(farthest, 1.06) << jump;
    EXPECT_NEAR(before, jump, 1e-6);
    const double shortest_s = 2.0 * std::sqrt(std::abs(jump) / kMost);
    EXPECT_LT(arrived * kStep_s, 1.1 * shortest_s + 0.003) << jump;
  }
}

}  // namespace
}  // namespace steadyrest::kernel::offset
