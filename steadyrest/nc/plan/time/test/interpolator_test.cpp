// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <cmath>
#include <numbers>

#include <gtest/gtest.h>

#include <steadyrest/nc/plan/test/moves.hpp>
#include <steadyrest/nc/plan/time/interpolator.hpp>
#include <steadyrest/nc/plan/time/test/interpolated.hpp>

namespace steadyrest::nc::plan {
namespace {

using test::kPeriod_s;
using test::mill;
using test::plan_of;
using test::Program;
using test::run;
using test::seconds;

struct Extremes {
  double speed = 0.0;
  double acceleration = 0.0;
  double jerk = 0.0;
};

/// Finite differences of the setpoints of one axis.
Extremes extremes(const std::vector<Setpoint>& s, std::size_t axis, double start) {
  Extremes out;
  std::vector<double> p(3, start);
  for (const auto& setpoint : s) {
    p.push_back(setpoint.position[axis]);
  }
  p.insert(p.end(), 3, s.back().position[axis]);
  for (std::size_t i = 3; i < p.size(); ++i) {
    const double v = (p[i] - p[i - 1]) / kPeriod_s;
    const double a = (p[i] - 2 * p[i - 1] + p[i - 2]) / (kPeriod_s * kPeriod_s);
    const double j =
        (p[i] - 3 * p[i - 1] + 3 * p[i - 2] - p[i - 3]) / (kPeriod_s * kPeriod_s * kPeriod_s);
    out.speed = std::max(out.speed, std::abs(v));
    out.acceleration = std::max(out.acceleration, std::abs(a));
    out.jerk = std::max(out.jerk, std::abs(j));
  }
  return out;
}

TEST(Interpolator, LineTakesTheClosedFormTimeOfTheTrapezoid) {
  const auto m = mill();
  for (const double length : {200.0, 20.0, 1.0, 0.05}) {
    for (const double feed : {150.0, 50.0, 5.0}) {
      Program p;
      p.line(length, 0, feed);
      const double a = m.axes[0].max_acceleration_au_s2;
      // Trapezoid: L/V + V/A; if the feed is never reached, the triangle 2·√(L/A).
      const double full =
          length >= feed * feed / a ? length / feed + feed / a : 2 * std::sqrt(length / a);
      const auto s = run(m, plan_of(m, p));
      EXPECT_NEAR(seconds(s), full, 2.01 * kPeriod_s) << length << " mm at " << feed;
      EXPECT_EQ(s.back().position[0], length);
    }
  }
}

TEST(Interpolator, LineTakesTheClosedFormTimeOfTheSCurve) {
  const double jerk = 50000.0;
  const auto m = mill(jerk);
  const double a = m.axes[0].max_acceleration_au_s2;
  for (const double length : {200.0, 50.0, 20.0}) {
    Program p;
    const double feed = 150.0;
    p.line(length, 0, feed);
    // Peak speed of the S-curve whose acceleration reaches a: L = v·(v/a + a/J).
    const double tj = a / jerk;
    const double peak = std::min(feed, 0.5 * a * (std::sqrt(tj * tj + 4 * length / a) - tj));
    const double time = length / peak + peak / a + tj;
    const auto s = run(m, plan_of(m, p));
    EXPECT_NEAR(seconds(s), time, 4.0 * kPeriod_s) << length;
    EXPECT_EQ(s.back().position[0], length);
    const auto x = extremes(s, 0, 0.0);
    EXPECT_LE(x.speed, feed * (1 + 1e-9));
    EXPECT_LE(x.acceleration, a * (1 + 1e-6));
    EXPECT_LE(x.jerk, jerk * (1 + 1e-6));
    EXPECT_GE(x.jerk, 0.9 * jerk);  // and the limit is used
  }
}

TEST(Interpolator, ShortLinesKeepAccelerationAndJerk) {
  const double jerk = 30000.0;
  const auto m = mill(jerk);
  for (const double length : {10.0, 3.0, 1.0, 0.1, 0.003}) {
    Program p;
    p.line(length, 0, 200);
    const auto s = run(m, plan_of(m, p));
    const auto x = extremes(s, 0, 0.0);
    EXPECT_LE(x.acceleration, 2000.0 * (1 + 1e-6)) << length;
    EXPECT_LE(x.jerk, jerk * (1 + 1e-6)) << length;
    EXPECT_EQ(s.back().position[0], length);
  }
}

TEST(Interpolator, CircleKeepsFeedAndReturnsToItsStart) {
  const auto m = mill();
  Program p;
  p.at = {10, 0, 0};
  p.arc(10, 0, 0, 0, 1, 4000.0 / 60.0);
  const auto path = plan_of(m, p);
  ASSERT_EQ(path.segments.size(), 1U);
  EXPECT_NEAR(path.segments[0].length_mm, 20 * std::numbers::pi, 1e-9);
  const auto s = run(m, path);
  for (const auto& setpoint : s) {
    EXPECT_NEAR(std::hypot(setpoint.position[0], setpoint.position[1]), 10.0, 1e-9);
  }
  EXPECT_EQ(s.back().position[0], 10.0);
  EXPECT_NEAR(s[s.size() / 2].path_speed_mm_s, 4000.0 / 60.0, 1e-9);
  const auto x = extremes(s, 0, 10.0);
  EXPECT_LE(x.acceleration, 2000.0);
}

TEST(Interpolator, TinySegmentsOfACircleDoNotStop) {
  for (const double jerk : {kernel::machine::kUnlimited, 50000.0}) {
    const auto m = mill(jerk);
    Program p;
    p.at = {10, 0, 0};
    const int n = 720;
    for (int i = 1; i <= n; ++i) {
      const double t = 2 * std::numbers::pi * i / n;
      p.line(10 * std::cos(t), 10 * std::sin(t), 50.0);
    }
    const auto s = run(m, plan_of(m, p));
    // Length over feed and a ramp at either end, as if the path were one line; facets may cost 10
    // %.
    const double ideal = 20 * std::numbers::pi / 50.0 + 50.0 / 2000.0;
    EXPECT_LT(seconds(s), 1.1 * ideal + 0.1);
    EXPECT_GT(seconds(s), 0.99 * ideal);
    double slowest = 1e9;
    for (std::size_t i = s.size() / 4; i < s.size() / 2; ++i) {
      slowest = std::min(slowest, s[i].path_speed_mm_s);
    }
    EXPECT_GT(slowest, 45.0);
  }
}

TEST(Interpolator, RefusesAMachineWithoutAPeriod) {
  auto m = mill();
  m.control.interpolator_period_s = 0.0;
  EXPECT_FALSE(Interpolator::make(m, PathWindow{}).has_value());
  m = mill(1.0);
  EXPECT_FALSE(Interpolator::make(m, PathWindow{}).has_value());
}

TEST(Interpolator, AProgramWithoutMotionFinishes) {
  const auto m = mill();
  EXPECT_TRUE(run(m, PlannedPath{}).empty());
  Program p;
  p.dwell(0.1);
  EXPECT_EQ(run(m, plan_of(m, p)).size(), 100U);
}

// Where the positions between are not worked out, nothing else changes: at a dwell the machine
// stands where the cut before it ended.
TEST(Interpolator, IsTheSameWhereFewPositionsAreWorkedOut) {
  for (const double jerk : {0.0, 50000.0}) {
    const auto m = jerk > 0.0 ? mill(jerk) : mill();
    Program p;
    p.line(20, 0, 50.0);
    p.dwell(0.05);
    p.arc(30, 10, 20, 10, 1, 40.0);
    p.line(30, 40, 80.0);
    const auto path = plan_of(m, p);
    auto every = Interpolator::make(m, whole(path)).value();
    auto some = Interpolator::make(m, whole(path)).value();
    for (std::size_t i = 0; !every.finished(); ++i) {
      ASSERT_LT(i, 10'000U);
      const bool placed = i % 5 == 0;
      const Setpoint is = every.update({});
      const Setpoint was = some.update({}, placed);
      ASSERT_EQ(was.motion, is.motion) << i;
      ASSERT_EQ(was.line, is.line) << i;
      ASSERT_EQ(was.finished, is.finished) << i;
      ASSERT_EQ(was.path_position_mm, is.path_position_mm) << i;
      ASSERT_EQ(was.path_speed_mm_s, is.path_speed_mm_s) << i;
      if (placed || is.motion == kernel::signal::Motion::dwell || is.finished) {
        ASSERT_EQ(was.position, is.position) << i;
      }
    }
  }
}

}  // namespace
}  // namespace steadyrest::nc::plan
