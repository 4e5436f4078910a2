// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <cmath>
#include <numbers>
#include <random>

#include <gtest/gtest.h>

#include <steadyrest/nc/plan/test/moves.hpp>
#include <steadyrest/nc/plan/time/test/interpolated.hpp>

namespace steadyrest::nc::plan {
namespace {

using kernel::signal::Motion;
using test::kPeriod_s;
using test::mill;
using test::plan_of;
using test::Program;
using test::run;
using test::seconds;

/// Largest excess over the junction limits; v² is linear in the path within a cycle.
double junction_excess(const PlannedPath& path, const std::vector<Setpoint>& s) {
  double worst = 0.0;
  for (std::size_t i = 1; i < s.size(); ++i) {
    for (std::size_t k = s[i - 1].path_index; k < s[i].path_index; ++k) {
      const double at = path.segments[k].position_mm + path.segments[k].length_mm;
      const double span = s[i].path_position_mm - s[i - 1].path_position_mm;
      const double share = span > 0 ? (at - s[i - 1].path_position_mm) / span : 0.0;
      const double v0 = s[i - 1].path_speed_mm_s;
      const double v1 = s[i].path_speed_mm_s;
      const double v = std::sqrt(v0 * v0 + share * (v1 * v1 - v0 * v0));
      worst = std::max(worst, v - path.segments[k].exit_speed_limit_mm_s);
    }
  }
  return worst;
}

TEST(Interpolator, JunctionLimitsHoldWhateverTheOverrideDoes) {
  for (const double jerk : {kernel::machine::kUnlimited, 40000.0}) {
    const auto m = mill(jerk);
    std::mt19937 random(7);
    std::uniform_real_distribution<double> unit(0.0, 1.0);
    for (int trial = 0; trial < 40; ++trial) {
      Program p;
      double angle = 0.0;
      double x = 0.0;
      double y = 0.0;
      for (int i = 0; i < 60; ++i) {
        const double length = std::pow(10.0, -1.5 + 3.0 * unit(random));
        angle += (unit(random) - 0.5) * (unit(random) < 0.3 ? 4.0 : 0.3);
        x += length * std::cos(angle);
        y += length * std::sin(angle);
        p.line(x, y, 20.0 + 150.0 * unit(random));
      }
      const auto path = plan_of(m, p);
      double ratio = 1.0;
      const auto s = run(m, path, [&](std::size_t i) {
        if (i % 50 == 0) {
          ratio = unit(random) < 0.2 ? 0.02 : 1.2 * unit(random);
        }
        return Overrides{ratio, 1.0, 0.0};
      });
      ASSERT_EQ(s.back().position[0], x);
      // With a jerk limit the average passes a joint a little off the lead's speed.
      EXPECT_LT(junction_excess(path, s), jerk > 1e9 ? 1e-6 : 0.5) << "trial " << trial;
      double worst_a = 0.0;
      for (std::size_t i = 1; i < s.size(); ++i) {
        worst_a = std::max(worst_a,
                           std::abs(s[i].path_speed_mm_s - s[i - 1].path_speed_mm_s) / kPeriod_s);
        EXPECT_LE(s[i].path_speed_mm_s,
                  path.segments[s[i].path_index].speed_limit_mm_s * (1 + 1e-9));
      }
      EXPECT_LE(worst_a, 2000.0 * std::numbers::sqrt2 * (1 + 1e-6));
    }
  }
}

TEST(Interpolator, OverrideScalesTheFeedAndZeroHolds) {
  const auto m = mill();
  Program p;
  p.line(300, 0, 50);
  const auto s = run(m, plan_of(m, p), [](std::size_t i) {
    Overrides o;
    o.feed_ratio = i < 1000 ? 1.2 : i < 2000 ? 0.5 : i < 3000 ? 0.0 : 1.0;
    return o;
  });
  EXPECT_NEAR(s[900].path_speed_mm_s, 60.0, 1e-9);
  EXPECT_NEAR(s[1900].path_speed_mm_s, 25.0, 1e-9);
  EXPECT_EQ(s[2900].path_speed_mm_s, 0.0);
  EXPECT_EQ(s[2900].position, s[2500].position);
  EXPECT_NEAR(s[3900].path_speed_mm_s, 50.0, 1e-9);
}

TEST(Interpolator, OverrideActsAtOnceWithinTheAcceleration) {
  const auto m = mill();
  Program p;
  p.line(300, 0, 100);
  const auto s = run(m, plan_of(m, p), [](std::size_t i) {
    Overrides o;
    o.feed_ratio = i < 1000 ? 1.0 : 0.5;
    return o;
  });
  EXPECT_NEAR(s[999].path_speed_mm_s, 100.0, 1e-9);
  EXPECT_NEAR(s[1000].path_speed_mm_s, 98.0, 1e-9);  // 2000 mm/s² for one period
  EXPECT_NEAR(s[1024].path_speed_mm_s, 50.0, 1e-9);
}

TEST(Interpolator, HigherOverrideIsNeverSlower) {
  for (const double jerk : {kernel::machine::kUnlimited, 50000.0}) {
    const auto m = mill(jerk);
    std::mt19937 random(11);
    std::uniform_real_distribution<double> unit(-1.0, 1.0);
    Program p;
    double x = 0;
    double y = 0;
    for (int i = 0; i < 80; ++i) {
      x += 4 * unit(random);
      y += 4 * unit(random);
      p.line(x, y, 60);
    }
    const auto path = plan_of(m, p);
    double before = 1e9;
    for (double ratio = 0.1; ratio < 1.6; ratio += 0.1) {
      const double t =
          seconds(run(m, path, [ratio](std::size_t) { return Overrides{ratio, 1, 0}; }));
      // Catches an exit speed planned for another override.
      EXPECT_LE(t, before + 80 * kPeriod_s) << ratio;  // each stop rounds up to a period
      before = t;
    }
  }
}

TEST(Interpolator, RapidFollowsTheRapidOverrideOnly) {
  const auto m = mill();
  Program p;
  p.rapid(200, 0);
  const auto s = run(m, plan_of(m, p), [](std::size_t) { return Overrides{0.1, 0.5, 0}; });
  EXPECT_NEAR(s[s.size() / 2].path_speed_mm_s, 100.0, 1e-9);
  EXPECT_EQ(s[10].motion, Motion::rapid);
}

TEST(Interpolator, ThreadAndTapIgnoreTheOverride) {
  const auto m = mill();
  Program p;
  auto& thread = p.add(interpret::MoveKind::thread, {0, 0, -20}, 1.5);
  thread.feed_mode = interpret::FeedMode::per_revolution;
  thread.spindle_rev_s = 10.0;
  auto& tap = p.add(interpret::MoveKind::linear, {0, 0, 0}, 15.0);
  tap.override_locked = true;
  const auto s = run(m, plan_of(m, p), [](std::size_t) { return Overrides{0.3, 1.0, 10.0}; });
  EXPECT_NEAR(s[500].path_speed_mm_s, 15.0, 1e-9);
  EXPECT_EQ(s[500].motion, Motion::thread);
  EXPECT_NEAR(s[2000].path_speed_mm_s, 15.0, 1e-9);
  EXPECT_EQ(s[2000].motion, Motion::tap);
}

TEST(Interpolator, HoldsWhenAnOverrideIsNotANumber) {
  const auto m = mill();
  Program p;
  p.line(100, 0, 50);
  const auto s = run(
      m, plan_of(m, p), [](std::size_t i) { return Overrides{i < 500 ? 1.0 : NAN, 1.0, 0.0}; },
      2000);
  EXPECT_EQ(s.size(), 2000U);
  EXPECT_EQ(s.back().path_speed_mm_s, 0.0);
}

}  // namespace
}  // namespace steadyrest::nc::plan
