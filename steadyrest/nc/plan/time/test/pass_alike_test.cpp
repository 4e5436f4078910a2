// SPDX-License-Identifier: Apache-2.0
// Periods that are alike are passed at once: the time is that of every period by itself, and months
// cost no more than minutes.
#include <cmath>
#include <string>

#include <gtest/gtest.h>
#include <rapidcheck/gtest.h>

#include <steadyrest/nc/plan/test/moves.hpp>
#include <steadyrest/nc/plan/time/program_timer.hpp>
#include <steadyrest/nc/plan/time/spindle_clock.hpp>

namespace steadyrest::nc::plan {
namespace {

using interpret::EventKind;
using test::mill;
using test::Program;

constexpr double kPassPeriod_s = 0.001;

ProgramTime timed(const kernel::machine::Machine& machine, const Program& program) {
  auto timer = ProgramTimer::make(machine).value();
  for (const auto& move : program.moves) {
    timer.on_move(move);
  }
  return timer.take().value();
}

/// Updates until the program is finished: each of a period, and what is passed behind it.
struct Steps {
  std::size_t updates = 0;
  std::size_t periods = 0;
};
Steps stepped(const kernel::machine::Machine& machine, const PlannedPath& path, bool pass) {
  auto interpolator = Interpolator::make(machine, whole(path)).value();
  Steps out;
  for (; !interpolator.update({}).finished; ++out.updates) {
    out.periods += 1 + (pass ? interpolator.pass_alike() : 0);
  }
  return out;
}

RC_GTEST_PROP(PassAlike, TakesTheTimeOfEveryPeriodByItself, ()) {
  const auto m = mill(*rc::gen::element(kernel::machine::kUnlimited, 50000.0, 5000.0));
  Program p;
  const int moves = *rc::gen::inRange(1, 8);
  for (int i = 0; i < moves; ++i) {
    p.mode = *rc::gen::element(interpret::PathMode::exact_path, interpret::PathMode::exact_stop,
                               interpret::PathMode::continuous);
    const double x = *rc::gen::inRange(-200, 200);
    const double y = *rc::gen::inRange(-3, 200);
    switch (*rc::gen::inRange(0, 4)) {
      case 0:
        p.rapid(x, y);
        break;
      case 1:
        p.dwell(0.01 * x * x);
        break;
      default:
        p.line(x, y, *rc::gen::element(0.7, 5.0, 33.0, 150.0));
    }
  }
  p.line(1.0, 2.0, 10.0);
  const PlannedPath path = test::plan_of(m, p);
  const Steps one = stepped(m, path, false);
  const Steps many = stepped(m, path, true);
  // A period at an end may be rounded to the other side.
  RC_ASSERT(std::abs(static_cast<double>(many.periods) - static_cast<double>(one.periods)) <=
            1.0 + static_cast<double>(moves));
}

TEST(PassAlike, WeeksAtOneSpeedCostNoMoreThanMinutes) {
  for (const double jerk : {kernel::machine::kUnlimited, 50000.0}) {
    const auto m = mill(jerk);
    Program minutes;
    minutes.line(1e4, 0, 20.0);
    minutes.dwell(60.0);
    Program weeks;
    weeks.line(2e7, 0, 20.0);
    weeks.dwell(1e6);
    const Steps few = stepped(m, test::plan_of(m, minutes), true);
    const Steps many = stepped(m, test::plan_of(m, weeks), true);
    EXPECT_LT(many.updates, few.updates + 2000) << jerk;
    EXPECT_LT(few.updates, 2000U) << jerk;
    // L/V, ramps of V/A, and A/J where the jerk is limited; then the dwell.
    EXPECT_NEAR(static_cast<double>(many.periods) * kPassPeriod_s, 2e7 / 20.0 + 1e6, 0.1) << jerk;
  }
}

TEST(PassAlike, TheAccountIsTheSameByKindToolAndLine) {
  const auto m = mill();
  Program p;
  p.line(1000, 0, 5.0);
  p.dwell(100.0);
  p.rapid(0, 0);
  const ProgramTime t = timed(m, p);
  EXPECT_NEAR(t.cut_s, 200.0, 0.05);
  EXPECT_NEAR(t.dwell_s, 100.0, 0.005);
  EXPECT_NEAR(t.line_s[1], 200.0, 0.05);
  ASSERT_EQ(t.cyclogram.size(), 1U);
  EXPECT_NEAR(t.cyclogram[0].path_mm, 2000.0, 0.01);
  EXPECT_NEAR(t.cyclogram[0].cut_mm, 1000.0, 0.01);
}

// The drive turns no faster than it can, whatever S asks for: the wait ends, and a feed per
// revolution is that of the speed that it has.
TEST(SpindleClock, ReachesNoMoreThanTheMachine) {
  auto m = mill();
  m.spindle.max_rev_s = 100.0;
  m.spindle.acceleration_rev_s2 = 50.0;
  SpindleClock clock(m.spindle);
  clock.command(-1e4);
  EXPECT_NEAR(clock.seconds_to_speed(), 0.95 * 2.0, 1e-9);
  clock.advance(10.0);
  EXPECT_DOUBLE_EQ(clock.speed_rev_s(), -100.0);
  EXPECT_FALSE(clock.ramps());

  auto timer = ProgramTimer::make(m).value();
  timer.set_overrides(1.0, 1.0, 1.2);
  timer.on_event({EventKind::spindle, 1, 1e4});
  Program p;
  auto& cut = p.line(100, 0, 0.5);
  cut.feed_mode = interpret::FeedMode::per_revolution;
  cut.spindle_rev_s = 1e4;
  timer.on_move(p.moves.front());
  const ProgramTime t = timer.take().value();
  EXPECT_NEAR(t.spindle_wait_s, 1.9, 0.05);
  EXPECT_NEAR(t.cut_s, 100.0 / (0.5 * 100.0), 0.1);
}

}  // namespace
}  // namespace steadyrest::nc::plan
