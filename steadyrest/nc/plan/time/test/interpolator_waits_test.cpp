// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <cmath>

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
  // 0.1 rev/s per period: 95 % of 25 rev/s after 237.5 ms, 95 % of 60 (the largest speed, not 100)
  // after 570.
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

}  // namespace
}  // namespace steadyrest::nc::plan
