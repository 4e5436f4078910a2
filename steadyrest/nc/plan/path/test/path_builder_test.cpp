// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <cmath>
#include <numbers>
#include <random>

#include <gtest/gtest.h>

#include <steadyrest/math/geometry/segment.hpp>
#include <steadyrest/math/geometry/vector.hpp>
#include <steadyrest/nc/plan/test/moves.hpp>

namespace steadyrest::nc::plan {
namespace {

using kernel::signal::Geometry;
using kernel::signal::Motion;
using test::mill;
using test::plan_of;
using test::Program;

TEST(PathBuilder, MachineCoordinatesAreWorkPlusOffset) {
  Program p;
  p.line(10, 0, 50).offset = {100, 50, -20};
  const auto path = plan_of(mill(), p);
  EXPECT_EQ(path.segments[0].start_mm, (kernel::signal::Point{100, 50, -20}));
  EXPECT_EQ(path.segments[0].end_mm, (kernel::signal::Point{110, 50, -20}));
}

TEST(PathBuilder, ArcsOfEveryDirectionEndWhereProgrammed) {
  // turns = 1 is the short way from (10, 0) to (0, 10) counter-clockwise, −1 the long way
  // clockwise; each further turn adds 2π. The helix rises from Z5 to Z2.
  for (const int turns : {1, -1, 3, -2}) {
    Program p;
    p.at = {10, 0, 5};
    p.arc(0, 10, 0, 0, turns, 20, 2.0);
    const auto path = plan_of(mill(), p);
    const auto& s = path.segments[0];
    const double quarter = turns > 0 ? std::numbers::pi / 2 : 3 * std::numbers::pi / 2;
    EXPECT_NEAR(s.sweep_rad, quarter + 2 * std::numbers::pi * (std::abs(turns) - 1), 1e-12);
    EXPECT_NEAR(s.length_mm, std::hypot(10 * s.sweep_rad, 3.0), 1e-9);
    const auto end = math::geometry::point_at(s, 1.0);
    EXPECT_LT(math::geometry::distance(end, s.end_mm), 1e-9);
  }
}

// LinuxCNC 2.9 with axes of 200 mm/s and 250 mm/s along the path, F far beyond both: its
// requested-vel is 200 mm/s along X, 229.6 mm/s at 60.6° in a plane, 282.8 mm/s on a diagonal, and
// on the arc between two lines the larger of theirs.
TEST(PathBuilder, AnFBeyondTheAxesIsClippedAsLinuxCncClipsIt) {
  auto machine = mill();
  machine.control.clips_programmed_feed = true;
  machine.control.max_feed_mm_s = 250.0;
  for (auto& axis : machine.axes) {
    axis.max_speed_au_s = 200.0;
  }
  Program p;
  p.mode = interpret::PathMode::continuous;
  p.tolerance_mm = 0.1;
  p.line(50, 0, 5000);
  p.line(100, 50, 5000);
  p.line(100, 100, 150);
  const auto path = plan_of(machine, p);
  ASSERT_EQ(path.segments.size(), 5U);
  const double expected[] = {200.0, 282.843, 282.843, 282.843, 150.0};
  for (std::size_t i = 0; i < 5; ++i) {
    EXPECT_NEAR(path.plans[i].feed_mm_s, expected[i], 0.001) << i;
    EXPECT_EQ(path.segments[i].feed_mm_s, path.plans[i].feed_mm_s) << i;
    EXPECT_LE(path.plans[i].speed_limit_mm_s, 250.0) << i;
  }
}

// LinuxCNC 2.9 with X and Y of 200 mm/s and 2000 mm/s², Z of 30 mm/s, F9000: its requested-vel is
// 41.618 mm/s on a half circle of R 1, 93.060 mm/s on one of R 5, 150 mm/s on one of R 20 and
// 38.147 mm/s on one of R 1 that goes down by 4 mm.
TEST(PathBuilder, AnFBeyondTheAxesIsClippedOnArcsAsLinuxCncClipsIt) {
  auto machine = mill();
  machine.control.clips_programmed_feed = true;
  machine.control.centripetal_share = std::sqrt(0.75);
  for (auto& axis : machine.axes) {
    axis.max_speed_au_s = 200.0;
    axis.max_acceleration_au_s2 = 2000.0;
  }
  machine.axes[2].max_speed_au_s = 30.0;
  Program p;
  p.arc(2, 0, 1, 0, -1, 150);
  p.arc(12, 0, 7, 0, -1, 150);
  p.arc(52, 0, 32, 0, -1, 150);
  p.arc(54, 0, 53, 0, -1, 150, -4.0);
  const auto path = plan_of(machine, p);
  ASSERT_EQ(path.segments.size(), 4U);
  const double expected[] = {41.618, 93.060, 150.0, 38.147};
  for (std::size_t i = 0; i < 4; ++i) {
    EXPECT_NEAR(path.plans[i].feed_mm_s, expected[i], 0.001) << i;
  }
}

TEST(PathBuilder, ASpiralEndsAtItsOtherRadius) {
  Program p;
  p.at = {10, 0, 0};
  p.arc(-5, 0, 0, 0, 2, 20);
  const auto s = plan_of(mill(), p).segments[0];
  EXPECT_NEAR(s.radius_end_mm, 5.0, 1e-12);
  // From angle 0 to angle π, and one turn more.
  EXPECT_NEAR(s.sweep_rad, 3 * std::numbers::pi, 1e-12);
  EXPECT_LT(math::geometry::distance(math::geometry::point_at(s, 1.0), s.end_mm), 1e-9);
}

TEST(PathBuilder, ARightAngleIsRoundedWithinTheTolerance) {
  Program p;
  p.mode = interpret::PathMode::continuous;
  p.tolerance_mm = 0.1;
  p.line(50, 0, 100);
  p.line(50, 50, 100);
  const auto path = plan_of(mill(), p);
  ASSERT_EQ(path.segments.size(), 3U);
  const auto& arc = path.segments[1];
  ASSERT_EQ(arc.geometry, Geometry::arc);
  // R·(√2 − 1) = tolerance at a right angle; the arc's middle is then off the corner by the
  // tolerance.
  const double radius = 0.1 / (std::numbers::sqrt2 - 1.0);
  EXPECT_NEAR(arc.radius_mm, radius, 1e-9);
  EXPECT_NEAR(arc.speed_limit_mm_s, std::sqrt(0.866 * 2000 * radius), 1e-6);
  const auto middle = math::geometry::point_at(arc, 0.5);
  EXPECT_NEAR(math::geometry::distance(middle, {50, 0, 0}), 0.1, 1e-9);
}

TEST(PathBuilder, PathIsContiguousAndNeverFurtherFromTheCornersThanTheTolerance) {
  std::mt19937 random(3);
  std::uniform_real_distribution<double> unit(-1.0, 1.0);
  for (int trial = 0; trial < 50; ++trial) {
    Program p;
    p.mode = interpret::PathMode::continuous;
    // 1 µm to 10 mm, with legs of 0.03 mm to 30 mm: tolerance and room both bind.
    p.tolerance_mm = std::pow(10.0, 2.0 * unit(random) - 1.0);
    double scale = 1.0;
    for (int i = 0; i < 100; ++i) {
      scale = std::pow(10.0, 1.5 * unit(random));
      p.line(p.at[0] + scale * unit(random), p.at[1] + scale * unit(random), 80,
             p.at[2] + scale * unit(random));
    }
    const auto path = plan_of(mill(), p);
    double s = 0.0;
    for (std::size_t i = 0; i < path.segments.size(); ++i) {
      const auto& segment = path.segments[i];
      EXPECT_NEAR(segment.position_mm, s, 1e-9);
      s += segment.length_mm;
      if (i > 0) {
        EXPECT_LT(math::geometry::distance(path.segments[i - 1].end_mm, segment.start_mm), 1e-9);
        EXPECT_LE(path.segments[i - 1].exit_speed_limit_mm_s, segment.speed_limit_mm_s);
      }
      if (segment.geometry == Geometry::arc) {
        // Distance of an arc from its corner, from its own radius and sweep: independent of how it
        // was chosen.
        const double deviation = segment.radius_mm * (1 / std::cos(segment.sweep_rad / 2) - 1);
        EXPECT_LE(deviation, p.tolerance_mm * (1 + 1e-9));
      }
    }
    EXPECT_EQ(path.segments.back().exit_speed_limit_mm_s, 0.0);
  }
}

TEST(PathBuilder, ExactPathKeepsTheCornerAndExactStopStops) {
  Program p;
  p.line(50, 0, 100);
  p.line(50, 50, 100);
  auto path = plan_of(mill(), p);
  ASSERT_EQ(path.segments.size(), 2U);
  // G61 keeps the corner exact and may pass it slowly; only G61.1 stops there.
  EXPECT_GT(path.segments[0].exit_speed_limit_mm_s, 0.0);
  for (auto& move : p.moves) {
    move.path_mode = interpret::PathMode::exact_stop;
  }
  path = plan_of(mill(), p);
  EXPECT_EQ(path.segments[0].exit_speed_limit_mm_s, 0.0);
}

TEST(PathBuilder, EventsStopThePathBeforeTheirSegment) {
  const auto machine = mill();
  PathBuilder builder(machine);
  Program p;
  p.line(10, 0, 50);
  p.line(20, 0, 50);
  builder.on_event({interpret::EventKind::spindle, 1, 20.0});
  builder.on_move(p.moves[0]);
  builder.on_event({interpret::EventKind::coolant, 2, 1.0});
  builder.on_move(p.moves[1]);
  const auto path = builder.take().value();
  ASSERT_EQ(path.events.size(), 3U);
  EXPECT_EQ(path.events[0].kind, PathEventKind::spindle);
  // A spindle start waits before the first feed move, not where M3 is written: the ramp passes
  // during rapids.
  EXPECT_EQ(path.events[1].kind, PathEventKind::spindle_wait);
  EXPECT_EQ(path.events[1].segment, 0U);
  EXPECT_EQ(path.events[2].kind, PathEventKind::coolant);
  EXPECT_EQ(path.events[2].segment, 1U);
  EXPECT_EQ(path.segments[0].exit_speed_limit_mm_s, 0.0);
}

TEST(PathBuilder, InverseTimeTakesItsTime) {
  Program p;
  p.line(30, 40, 0.5).feed_mode = interpret::FeedMode::inverse_time;
  // 0.5 moves/s over √(30² + 40²) = 50 mm.
  EXPECT_NEAR(plan_of(mill(), p).segments[0].feed_mm_s, 25.0, 1e-9);
}

TEST(PathBuilder, RotaryAxesAloneMoveInDegreesPerSecond) {
  auto m = mill();
  kernel::machine::Axis a;
  a.name = "A";
  a.rotary = true;
  a.max_speed_au_s = std::numbers::pi;  // 180 °/s
  a.max_acceleration_au_s2 = 10.0;
  m.axes.push_back(a);
  Program p;
  p.add(interpret::MoveKind::linear, {0, 0, 0, 90}, 30.0);
  auto path = plan_of(m, p);
  // Degrees along the path, rad inside; π rad/s are 180°/s.
  EXPECT_NEAR(path.segments[0].length_mm, 90.0, 1e-9);
  EXPECT_NEAR(path.segments[0].other_end[0], std::numbers::pi / 2, 1e-12);
  EXPECT_NEAR(path.segments[0].speed_limit_mm_s, 180.0, 1e-9);
}

TEST(PathBuilder, MarksThreadsProbesAndLockedMoves) {
  Program p;
  p.add(interpret::MoveKind::thread, {0, 0, -5}, 1.0).override_locked = true;
  p.add(interpret::MoveKind::probe, {0, 0, -9}, 1.0);
  p.add(interpret::MoveKind::linear, {0, 0, 0}, 1.0).override_locked = true;
  const auto path = plan_of(mill(), p);
  EXPECT_EQ(path.segments[0].motion, Motion::thread);
  EXPECT_EQ(path.segments[1].motion, Motion::probe);
  EXPECT_EQ(path.segments[2].motion, Motion::tap);
  EXPECT_EQ(path.segments[0].exit_speed_limit_mm_s, 0.0);
  EXPECT_TRUE(path.plans[2].locked);
}

TEST(PathBuilder, ConstantCuttingSpeedTurnsTheSpindleByTheRadius) {
  auto m = mill();
  m.spindle.max_rev_s = 50.0;
  for (const double radius : {20.0, 2.0}) {
    Program p;
    p.at = {radius, 0, 0};
    auto& move = p.add(interpret::MoveKind::linear, {radius, 0, -30}, 0.2);
    move.feed_mode = interpret::FeedMode::per_revolution;
    move.surface_speed_mm_s = -2000.0;
    const auto path = plan_of(m, p);
    // Cutting speed divided by circumference, limited to the spindle's largest speed at the small
    // radius.
    const double spindle = std::min(50.0, 2000.0 / (2 * std::numbers::pi * radius));
    EXPECT_NEAR(path.plans[0].spindle_rev_s, -spindle, 1e-9);
    EXPECT_NEAR(path.segments[0].feed_mm_s, 0.2 * spindle, 1e-9);
  }
}

TEST(PathBuilder, RefusesWhatItCannotPlan) {
  for (const int fault : {0, 1, 2}) {
    const auto machine = mill();
    PathBuilder builder(machine);
    Program p;
    auto& move = p.line(10, 0, 50);
    if (fault == 0) {
      move.feed_mm_s = 0.0;
    } else if (fault == 1) {
      move.end[1] = NAN;
    } else {
      move.kind = interpret::MoveKind::spline;
    }
    builder.on_move(move);
    const auto path = builder.take();
    ASSERT_FALSE(path.has_value());
    // A fault must name the line it is in, and what to do about it.
    EXPECT_EQ(path.error().line, 1U);
    EXPECT_FALSE(path.error().to_do.empty());
  }
}

}  // namespace
}  // namespace steadyrest::nc::plan
