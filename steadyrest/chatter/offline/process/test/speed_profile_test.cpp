// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <cmath>
#include <initializer_list>
#include <limits>
#include <numbers>

#include <gtest/gtest.h>

#include <steadyrest/chatter/offline/process/speed_profile.hpp>

namespace steadyrest::chatter::offline {
namespace {

using online::Law;

constexpr double kOneTurn = 2.0 * std::numbers::pi;
constexpr double kMean_rev_s = 50.0;

Modulation modulated(Law law, double rva = 0.2, double rvf = 0.1) {
  return {.law = law, .rva = rva, .rvf = rvf, .seed = 3};
}

// Ω = Ω₀·(1 + RVA·sin ωt), ω = RVF·Ω₀, has θ = Ω₀·t + RVA/RVF·(1 − cos ωt).
TEST(SpeedProfile, OfASineIsItsIntegral) {
  const SpeedProfile profile(kMean_rev_s, modulated(Law::sine));
  const double mean = kOneTurn * kMean_rev_s;
  for (double t_s = 0.0; t_s < 0.5; t_s += 0.00737) {
    const double w = 0.1 * mean;
    const double angle = mean * t_s + 0.2 / 0.1 * (1.0 - std::cos(w * t_s));
    EXPECT_NEAR(profile.time_s(angle), t_s, 1e-13) << t_s;
    EXPECT_NEAR(profile.speed_rad_s(angle), mean * (1.0 + 0.2 * std::sin(w * t_s)), 1e-9) << t_s;
  }
}

// Ten revolutions at 50 rev/s take 0.2 s: the first 0.1 s at 60 rev/s, so six of them.
TEST(SpeedProfile, OfASquareRunsFastThroughTheFirstSixOfTenRevolutions) {
  const SpeedProfile profile(kMean_rev_s, modulated(Law::square));
  EXPECT_NEAR(profile.period_rad(), 10.0 * kOneTurn, 1e-9);
  EXPECT_NEAR(profile.time_s(6.0 * kOneTurn), 0.1, 1e-14);
  EXPECT_NEAR(profile.time_s(10.0 * kOneTurn), 0.2, 1e-14);
  EXPECT_NEAR(profile.speed_rad_s(5.9 * kOneTurn), 60.0 * kOneTurn, 1e-9);
  EXPECT_NEAR(profile.speed_rad_s(6.1 * kOneTurn), 40.0 * kOneTurn, 1e-9);
  EXPECT_NEAR(profile.slowest_rad_s(), 40.0 * kOneTurn, 1e-9);
  ASSERT_EQ(profile.corners_rad().size(), 2U);
  EXPECT_NEAR(profile.corners_rad()[1], 6.0 * kOneTurn, 1e-9);
}

// dt = dθ/Ω by the midpoint rule from corner to corner: the laws' own integrals are not used.
TEST(SpeedProfile, TimeIsTheIntegralOfTheInverseSpeedUnderEachLaw) {
  for (const Law law :
       {Law::square, Law::pulse, Law::triangle, Law::sine, Law::random, Law::stop}) {
    const SpeedProfile profile(kMean_rev_s, modulated(law, 0.3, 0.25));
    constexpr int kSteps = 60000;
    const double step = profile.period_rad() / kSteps;
    double t_s = 0.0;
    double slowest = std::numeric_limits<double>::infinity();
    for (int i = 0; i < kSteps; ++i) {
      const double speed = profile.speed_rad_s((i + 0.5) * step);
      slowest = std::min(slowest, speed);
      t_s += step / speed;
      if (i % 7919 == 0) {
        EXPECT_NEAR(profile.time_s((i + 1.0) * step), t_s, 2e-6) << online::name(law) << i;
      }
    }
    EXPECT_NEAR(t_s, 1.0 / (0.25 * kMean_rev_s), 2e-6) << "a period lasts 1/(RVF·n)";
    EXPECT_GE(slowest, profile.slowest_rad_s() * (1.0 - 1e-12)) << online::name(law);
  }
}

TEST(SpeedProfile, RepeatsBeforeAndAfterItsFirstPeriod) {
  const SpeedProfile profile(kMean_rev_s, modulated(Law::triangle));
  const double period_s = profile.time_s(profile.period_rad());
  for (const int periods : {-3, 1, 100}) {
    const double angle = 17.0 + periods * profile.period_rad();
    EXPECT_NEAR(profile.speed_rad_s(angle), profile.speed_rad_s(17.0), 1e-8);
    EXPECT_NEAR(profile.time_s(angle), profile.time_s(17.0) + periods * period_s, 1e-12);
  }
}

TEST(SpeedProfile, WithoutAnAmplitudeIsConstant) {
  for (const SpeedProfile& profile :
       {SpeedProfile(kMean_rev_s, {}), SpeedProfile(kMean_rev_s, modulated(Law::sine, 0.0))}) {
    EXPECT_TRUE(profile.constant());
    EXPECT_EQ(profile.speed_rad_s(123.4), profile.mean_rad_s());
    EXPECT_NEAR(profile.time_s(kOneTurn), 0.02, 1e-15);
  }
}

}  // namespace
}  // namespace steadyrest::chatter::offline
