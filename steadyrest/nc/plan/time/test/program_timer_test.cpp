// SPDX-License-Identifier: Apache-2.0
#include <cmath>
#include <numeric>
#include <random>

#include <gtest/gtest.h>

#include <steadyrest/nc/plan/test/moves.hpp>
#include <steadyrest/nc/plan/time/program_timer.hpp>

namespace steadyrest::nc::plan {
namespace {

using interpret::EventKind;
using test::mill;
using test::Program;

TEST(ProgramTimer, PartsAddUpToTheWhole) {
  auto m = mill();
  m.control.tool_change_s = 2.0;
  m.spindle.acceleration_rev_s2 = 100.0;
  auto timer = ProgramTimer::make(m).value();
  Program p;
  p.rapid(100, 0);
  p.line(100, 50, 25);
  p.dwell(1.5);
  p.line(0, 50, 25);
  timer.on_event({EventKind::tool_change, 1, 7.0});
  timer.on_event({EventKind::spindle, 2, 50.0});
  for (const auto& move : p.moves) {
    timer.on_move(move);
  }
  timer.on_event({EventKind::end, 9, 0.0});
  const auto t = timer.take().value();
  EXPECT_NEAR(t.dwell_s, 1.5, 1e-9);
  EXPECT_NEAR(t.tool_change_s, 2.0, 1e-9);
  // 100 mm at 200 mm/s and V/A = 0.1 s of ramps.
  EXPECT_NEAR(t.rapid_s, 100.0 / 200.0 + 0.1, 0.003);
  EXPECT_NEAR(t.cut_s, 150.0 / 25.0 + 2 * 25.0 / 2000.0, 0.005);
  EXPECT_NEAR(t.spindle_wait_s, 0.0, 0.003);  // 0.5 s of ramp pass during the rapid move of 0.6 s
  EXPECT_NEAR(t.total_s, t.cut_s + t.rapid_s + t.dwell_s + t.tool_change_s + t.spindle_wait_s,
              1e-6);
  EXPECT_NEAR(t.total_s, std::accumulate(t.line_s.begin(), t.line_s.end(), 0.0), 1e-6);
  ASSERT_EQ(t.tools.size(), 1U);
  EXPECT_EQ(t.tools[0].number, 7);
  EXPECT_NEAR(t.tools[0].seconds, t.total_s, 1e-6);
  EXPECT_NEAR(t.cut_mm, 150.0, 1e-9);
  EXPECT_EQ(t.moves, 4U);
}

TEST(ProgramTimer, TheMovingWindowGivesTheTimeOfTheWholePath) {
  for (const double jerk : {kernel::machine::kUnlimited, 50000.0}) {
    const auto m = mill(jerk);
    std::mt19937 random(5);
    std::uniform_real_distribution<double> unit(-1.0, 1.0);
    Program p;
    for (int i = 0; i < 6000; ++i) {
      p.line(p.at[0] + 0.5 * unit(random), p.at[1] + 0.5 * unit(random), 60.0);
      if (i % 1500 == 7) {
        p.dwell(0.01);
      }
    }
    auto timer = ProgramTimer::make(m).value();
    for (const auto& move : p.moves) {
      timer.on_move(move);
    }
    // The same path all in memory: the window must not change anything.
    const double whole_s = static_cast<double>(test::run(m, test::plan_of(m, p)).size()) * 0.001;
    EXPECT_NEAR(timer.take().value().total_s, whole_s, 1e-6);
  }
}

TEST(ProgramTimer, TheCyclogramHasATransitionForEachSpeedAndTool) {
  auto m = mill();
  m.control.tool_change_s = 2.0;
  m.spindle.acceleration_rev_s2 = 1000.0;
  auto timer = ProgramTimer::make(m).value();
  Program p;
  p.line(100, 0, 25);
  p.dwell(3.0);
  p.line(0, 0, 50);
  timer.on_event({EventKind::spindle, 1, 50.0});
  timer.on_move(p.moves[0]);
  timer.on_event({EventKind::spindle, 2, 0.0});
  timer.on_event({EventKind::tool_change, 3, 7.0});
  timer.on_event({EventKind::spindle, 4, -20.0});
  timer.on_move(p.moves[1]);
  timer.on_event({EventKind::spindle, 5, 30.0});
  timer.on_move(p.moves[2]);
  timer.on_event({EventKind::end, 9, 0.0});
  const auto t = timer.take().value();
  ASSERT_EQ(t.cyclogram.size(), 4U);
  EXPECT_EQ(t.cyclogram[0].load(), Load::cutting);
  EXPECT_NEAR(t.cyclogram[0].seconds, 4.0, 0.1);
  EXPECT_NEAR(t.cyclogram[0].feed_mm_s(), 25.0, 0.2);
  // The tool change with the spindle stopped is a separate transition.
  EXPECT_EQ(t.cyclogram[1].load(), Load::standing);
  EXPECT_NEAR(t.cyclogram[1].seconds, 2.0, 0.02);
  EXPECT_EQ(t.cyclogram[2].load(), Load::running);
  // Running without cutting: the dwell at −20 rev/s.
  EXPECT_EQ(t.cyclogram[2].speed_rev_s, -20.0);
  EXPECT_EQ(t.cyclogram[2].tool, 7);
  EXPECT_NEAR(t.cyclogram[2].seconds, 3.0, 0.02);
  EXPECT_EQ(t.cyclogram[3].load(), Load::cutting);
  double at = 0.0;
  for (const auto& transition : t.cyclogram) {
    EXPECT_NEAR(transition.start_s, at, 1e-9);
    at += transition.seconds;
  }
  EXPECT_NEAR(at, t.total_s, 1e-9);
}

TEST(ProgramTimer, OverridesStretchTheTime) {
  const auto seconds = [](double feed, double rapid) {
    const auto m = mill();
    auto timer = ProgramTimer::make(m).value();
    timer.set_overrides(feed, rapid, 1.0);
    Program p;
    p.line(200, 0, 10);
    timer.on_move(p.moves[0]);
    timer.on_event({EventKind::end, 9, 0.0});
    return timer.take().value().total_s;
  };
  // 200 mm at 10 mm/s; the rapid override must not touch a feed move.
  EXPECT_NEAR(seconds(1.0, 1.0), 20.0, 0.05);
  EXPECT_NEAR(seconds(0.5, 1.0), 40.0, 0.05);
  EXPECT_NEAR(seconds(1.0, 0.5), 20.0, 0.05);
}

TEST(ProgramTimer, EventsWithoutMovesPass) {
  auto m = mill();
  m.control.tool_change_s = 0.5;
  auto timer = ProgramTimer::make(m).value();
  for (std::uint32_t i = 1; i <= 1000; ++i) {
    timer.on_event({EventKind::coolant, i, 1.0});
  }
  timer.on_event({EventKind::tool_change, 1001, 1.0});
  timer.on_event({EventKind::tool_change, 1002, 2.0});
  const auto t = timer.take().value();
  // 1000 coolant events cost no time and must pass the ring of 256; the two changes take 0.5 s
  // each.
  EXPECT_NEAR(t.total_s, 1.0, 0.003);
  EXPECT_EQ(t.tools.size(), 2U);
}

TEST(ProgramTimer, RefusesWhatThePlannerRefusesAndWhatNeverEnds) {
  const auto m = mill();
  auto timer = ProgramTimer::make(m).value();
  Program p;
  p.line(10, 0, 0.0);
  timer.on_move(p.moves[0]);
  EXPECT_FALSE(timer.take().has_value());
}

// By length over feed, before a single period is run; likewise for feeds per revolution and dwells.
TEST(ProgramTimer, RefusesAMoveOfMonthsAtOnceWithItsLine) {
  const auto m = mill();
  const auto refusal_of = [&m](const auto& change) {
    auto timer = ProgramTimer::make(m).value();
    Program p;
    p.line(10, 0, 10.0);
    p.line(20, 0, 10.0);
    change(p.moves[1]);
    std::size_t arrivals = 0;
    timer.set_arrival([&arrivals](std::uint32_t, double) { ++arrivals; });
    for (const auto& move : p.moves) {
      timer.on_move(move);
    }
    const auto refused = timer.take();
    EXPECT_FALSE(refused.has_value());
    EXPECT_LE(arrivals, 1U);
    return refused ? kernel::outcome::Refusal{} : refused.error();
  };
  for (const auto& refusal :
       {refusal_of([](auto& move) { move.feed_mm_s = 1e-6 / 60.0; }), refusal_of([](auto& move) {
          move.feed_mode = interpret::FeedMode::per_revolution;
          move.feed_mm_s = 1e-7;
          move.spindle_rev_s = -10.0;
        }),
        refusal_of([](auto& move) {
          move.kind = interpret::MoveKind::dwell;
          move.dwell_s = 1e7;
        })}) {
    EXPECT_EQ(refusal.line, 2U);
    EXPECT_NE(refusal.what.find("30 days"), std::string::npos) << refusal.what;
  }
}

}  // namespace
}  // namespace steadyrest::nc::plan
