// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <cmath>
#include <set>
#include <vector>

#include <gtest/gtest.h>

#include <steadyrest/chatter/offline/cycle/multipliers.hpp>
#include <steadyrest/chatter/offline/plan/override_course.hpp>
#include <steadyrest/chatter/offline/test/cuts.hpp>
#include <steadyrest/chatter/offline/test/machines.hpp>

namespace steadyrest::chatter::offline::test {
namespace {

using online::Law;

constexpr double kSpeed_rev_s = 5000.0 / 60.0;

double log_radius(const std::vector<SpeedRamp>& course, double depth_mm) {
  DelayCycle::Config config;
  config.course = course;
  config.speed_rev_s = kSpeed_rev_s;
  config.most_depth_mm = depth_mm;
  auto cycle = DelayCycle::make(benchmark_cut(1.0, Direction::up), config).value();
  cycle.set_depth(depth_mm);
  return multipliers(cycle, 1).log_modulus[0];
}

/// The reference's triangle of RVA 0.2, RVF 0.1 as three ramps: ρ = 0.0032550985.
TEST(SpeedCourse, ATriangleOfRampsHasTheReferencesRadius) {
  const double period_s = 10.0 / kSpeed_rev_s;
  const double high = 1.2 * kSpeed_rev_s;
  const double low = 0.8 * kSpeed_rev_s;
  // The stability of the law itself is known to eight digits; built of ramps it must come out the
  // same.
  const std::vector<SpeedRamp> course{{0.25 * period_s, kSpeed_rev_s, high},
                                      {0.5 * period_s, high, low},
                                      {0.25 * period_s, low, kSpeed_rev_s}};
  EXPECT_NEAR(log_radius(course, 1.0), std::log(0.0032550985), 1e-6);
}

/// The same triangle without its corners: more than 64 ramps.
TEST(SpeedCourse, ManyRampsAreGoodToAThousandth) {
  std::vector<SpeedRamp> course;
  const double period_s = 10.0 / kSpeed_rev_s;
  for (int k = 0; k < 100; ++k) {
    const auto speed = [](int i) {
      return kSpeed_rev_s * (1.0 + 0.2 * online::SpeedLaw(Law::triangle).at(0.01 * i));
    };
    course.push_back({0.01 * period_s, speed(k), speed(k + 1)});
  }
  EXPECT_NEAR(log_radius(course, 1.0), std::log(0.0032550985), 5e-3);
}

TEST(SpeedCourse, TimeAndAngleBelongTogether) {
  const std::vector<SpeedRamp> course{{0.1, 50.0, 70.0}, {0.2, 70.0, 70.0}, {0.1, 70.0, 50.0}};
  const double angle = SpeedProfile::angle_rad(course);
  EXPECT_NEAR(angle, 2.0 * M_PI * (0.2 * 60.0 + 0.2 * 70.0), 1e-9);
  const SpeedProfile profile(course, angle);
  EXPECT_NEAR(profile.time_s(angle), 0.4, 1e-12);
  EXPECT_NEAR(profile.time_s(3.5 * angle), 1.4, 1e-12);
  for (double at = 0.0; at < angle; at += 0.37) {
    // dt/dθ = 1/Ω: time and speed are computed separately and must agree.
    const double h = 1e-5;
    const double slope = (profile.time_s(at + h) - profile.time_s(at)) / h;
    EXPECT_NEAR(slope * profile.speed_rad_s(at + 0.5 * h), 1.0, 1e-6);
  }
}

TEST(OverrideCourse, GoesThroughTheStepsAndComesBack) {
  const auto machine = light_spindle({80, 85, 90, 95, 100, 105, 110, 115, 120});
  const Modulation law{Law::triangle, 0.2, 0.02, 1};
  const auto course = override_course(machine, kSpeed_rev_s, law);
  ASSERT_TRUE(course.has_value());
  double duration_s = 0.0;
  std::set<int> levels;
  for (const SpeedRamp& ramp : *course) {
    duration_s += ramp.duration_s;
    // No ramp is steeper than the drive.
    EXPECT_LE(std::abs(ramp.to_rev_s - ramp.from_rev_s) / ramp.duration_s,
              machine.spindle.acceleration_rev_s2 * (1.0 + 1e-6));
    if (ramp.from_rev_s == ramp.to_rev_s) {
      levels.insert(static_cast<int>(std::lround(100.0 * ramp.to_rev_s / kSpeed_rev_s)));
    }
  }
  EXPECT_NEAR(duration_s, 1.0 / (0.02 * kSpeed_rev_s), 1e-9);
  EXPECT_EQ(levels, (std::set<int>{80, 85, 90, 95, 100, 105, 110, 115, 120}));
  EXPECT_NEAR(course->back().to_rev_s, course->front().from_rev_s, 1e-6 * kSpeed_rev_s);
  EXPECT_NEAR(SpeedProfile::angle_rad(*course) / duration_s / 2.0 / M_PI, kSpeed_rev_s,
              0.01 * kSpeed_rev_s);
}

TEST(OverrideCourse, ASlowDriveRampsAllTheTime) {
  auto machine = light_spindle({80, 90, 100, 110, 120});
  machine.spindle.acceleration_rev_s2 = 40.0;
  const auto course = override_course(machine, kSpeed_rev_s, {Law::square, 0.2, 0.02, 1});
  ASSERT_TRUE(course.has_value());
  double high = 0.0;
  for (const SpeedRamp& ramp : *course) {
    high = std::max(high, ramp.to_rev_s);
  }
  EXPECT_LT(high, 1.2 * kSpeed_rev_s) << "a quarter of a second at 40 rev/s² is 12 %";
}

}  // namespace
}  // namespace steadyrest::chatter::offline::test
