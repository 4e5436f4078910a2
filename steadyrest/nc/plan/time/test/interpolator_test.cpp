// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <cmath>
#include <numbers>
#include <random>

#include <gtest/gtest.h>

#include <steadyrest/nc/plan/test/moves.hpp>

namespace steadyrest::nc::plan {
namespace {

using kernel::signal::Motion;
using test::mill;
using test::plan_of;
using test::Program;
using test::run;

constexpr double kPeriod_s = 0.001;

double seconds(const std::vector<Setpoint>& s) {
  return static_cast<double>(s.size()) * kPeriod_s;
}

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
      const double a = m.axes[0].max_acceleration_mm_s2;
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
  const double a = m.axes[0].max_acceleration_mm_s2;
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
    // Length over feed and one ramp each way, as if the path were one line; facets may cost a
    // tenth.
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

TEST(Interpolator, FeedPerRevolutionFollowsTheSpindle) {
  const auto m = mill();
  Program p;
  auto& cut = p.line(100, 0, 0.5);
  cut.feed_mode = interpret::FeedMode::per_revolution;
  cut.spindle_rev_s = 20.0;
  const auto s = run(m, plan_of(m, p),
                     [](std::size_t i) { return Overrides{1.0, 1.0, i < 2000 ? 20.0 : 30.0}; });
  EXPECT_NEAR(s[1500].path_speed_mm_s, 10.0, 1e-9);
  EXPECT_NEAR(s[3000].path_speed_mm_s, 15.0, 1e-9);
}

TEST(Interpolator, ExactStopStopsAndDwellLasts) {
  for (const double jerk : {kernel::machine::kUnlimited, 50000.0}) {
    const auto m = mill(jerk);
    Program p;
    p.mode = interpret::PathMode::exact_stop;
    p.line(10, 0, 50);
    p.line(20, 0, 50);
    p.dwell(0.25);
    p.line(30, 0, 50);
    const auto s = run(m, plan_of(m, p));
    int at_corner = 0;
    int dwelling = 0;
    for (const auto& setpoint : s) {
      at_corner += setpoint.position[0] == 10.0 && setpoint.path_speed_mm_s == 0.0 ? 1 : 0;
      dwelling += setpoint.motion == Motion::dwell ? 1 : 0;
    }
    EXPECT_GE(at_corner, 1);
    EXPECT_EQ(dwelling, 250);
  }
}

TEST(Interpolator, WaitsForSpindleAndToolChange) {
  auto m = mill();
  m.control.tool_change_s = 0.5;
  PathBuilder builder(m);
  builder.on_event({interpret::EventKind::tool_change, 1, 3.0});
  builder.on_event({interpret::EventKind::spindle, 2, 50.0});
  Program p;
  p.line(10, 0, 50);
  builder.on_move(p.moves[0]);
  const auto path = builder.take().value();
  const auto s = run(m, path, [](std::size_t i) {
    return Overrides{1.0, 1.0,
                     std::max(0.0, std::min(50.0, 0.1 * (static_cast<double>(i) - 499.0)))};
  });
  const auto count = [&](Motion motion) {
    return std::count_if(s.begin(), s.end(), [&](const auto& x) { return x.motion == motion; });
  };
  EXPECT_EQ(count(Motion::tool_change), 500);
  EXPECT_NEAR(static_cast<double>(count(Motion::spindle_wait)), 475.0, 2.0);
  EXPECT_EQ(s[600].spindle_rev_s, 50.0);
}

TEST(Interpolator, WaitsForTheSpindleSpeedThatTheOverrideLeaves) {
  auto m = mill();
  m.spindle.max_rev_s = 60.0;
  // 0.1 rev/s per period: 95 % of 25 rev/s after 237.5 ms, 95 % of 60 (the most, not 100) after
  // 570.
  // programmed, override, actual at 1 rev/s for each 10 ms from 0, expected wait to 95 % in s
  const struct {
    double programmed, ratio, sign, wait_s;
  } rows[] = {{50.0, 0.5, 1.0, 0.2375}, {100.0, 1.0, 1.0, 0.57}, {-50.0, 1.0, -1.0, 0.475}};
  for (const auto& row : rows) {
    PathBuilder builder(m);
    builder.on_event({interpret::EventKind::spindle, 1, row.programmed});
    Program p;
    p.line(10, 0, 50);
    builder.on_move(p.moves[0]);
    const auto path = builder.take().value();
    const auto s = run(
        m, path,
        [&](std::size_t i) {
          const double target = std::min(std::abs(row.programmed) * row.ratio, 60.0);
          return Overrides{1.0, 1.0, row.sign * std::min(target, 0.1 * static_cast<double>(i)),
                           row.ratio};
        },
        5000);
    const auto waited = std::count_if(
        s.begin(), s.end(), [](const auto& x) { return x.motion == Motion::spindle_wait; });
    EXPECT_NEAR(static_cast<double>(waited) * kPeriod_s, row.wait_s, 0.002) << row.programmed;
  }
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

}  // namespace
}  // namespace steadyrest::nc::plan
