// SPDX-License-Identifier: Apache-2.0
// The commanded point's motion in a forecast, against the same law in steps 200 times finer.
#include <algorithm>
#include <array>
#include <cmath>
#include <vector>

#include <gtest/gtest.h>
#include <rapidcheck.h>
#include <rapidcheck/gtest.h>

#include <steadyrest/contour/online/forecast.hpp>
#include <steadyrest/contour/online/test/paths.hpp>
#include <steadyrest/kernel/machine/unlimited.hpp>
#include <steadyrest/math/geometry/test/segments.hpp>

namespace steadyrest::contour::online {
namespace {

using kernel::signal::Motion;
using math::geometry::test::number;
using test::PathMaker;
using test::PathSegment;

constexpr double kFeed_mm_s = 40.0;
constexpr double kAcceleration_mm_s2 = 1000.0;
constexpr double kStep_s = 0.5e-3;
const std::vector<double> kTable = {0.1, 0.2, 0.35, 0.5, 0.7, 0.8, 0.95, 1.0, 1.2};

Forecast::Timing timing() {
  return {.step_s = kStep_s,
          .dead_s = 0.02,
          .scan_s = 0.01,
          .fall_1_s = 10.0,
          .rise_1_s = 4.0,
          .settle_s = 0.05};
}

double step_below(double ratio) {
  const auto above = std::ranges::upper_bound(kTable, ratio + 1e-9);
  return above == kTable.begin() ? kTable.front() : *(above - 1);
}

/// r(t) as RatioPlan describes it.
double ratio_at(const RatioPlan& plan, double t_s) {
  const Forecast::Timing clock = timing();
  if (t_s <= clock.dead_s) {
    return plan.start;
  }
  const bool rises = plan.target > plan.start;
  const double change_s =
      std::abs(plan.target - plan.start) / (rises ? clock.rise_1_s : clock.fall_1_s);
  const double late_s = t_s - clock.dead_s - clock.scan_s;
  const double falls_s = late_s - change_s - plan.hold_s;
  if (falls_s > 0.0) {
    return std::max(plan.floor, plan.target - clock.fall_1_s * falls_s);
  }
  return rises ? std::min(plan.target, plan.start + clock.rise_1_s * (t_s - clock.dead_s))
               : std::max(plan.target, plan.start - clock.fall_1_s * std::max(0.0, late_s));
}

/// A forecast along a straight of 200 mm; positions of the command by time.
class Straight {
 public:
  explicit Straight(const std::vector<PathSegment>& path)
      : ahead_({}, kAcceleration_mm_s2), path_(path) {
    for (int i = 0; i < 20; ++i) {
      ahead_.update(path_, 0, 0.0, 0.0, 300.0);
    }
    forecast_.set_timing(timing());
    forecast_.set_model(std::array{AxisModel{}, AxisModel{}, AxisModel{}});
    forecast_.set_table(kTable);
    outset.speed_mm_s = kFeed_mm_s;
  }
  Forecast::Trace run(const RatioPlan& plan) {
    const auto dead = static_cast<std::size_t>(std::lround(timing().dead_s / kStep_s));
    forecast_.pending().fill(step_below(plan.start));
    forecast_.set_pending_count(dead);
    Forecast::Trace trace;
    static_cast<void>(forecast_.run(ahead_, outset, plan, 1e9, false, nullptr, &trace));
    return trace;
  }
  /// Time of trace entry i: nothing is recorded within the dead time.
  static double time_s(std::size_t i) {
    return kStep_s * (std::floor(timing().dead_s / kStep_s + 0.5) + 1.0 + static_cast<double>(i));
  }

  Outset outset;

 private:
  LookAhead ahead_;
  std::vector<PathSegment> path_;
  Forecast forecast_;
};

std::vector<PathSegment> straight_mm(double length_mm) {
  auto path = PathMaker({0, 0, 0}, kFeed_mm_s).line_to({length_mm, 0, 0}).path();
  return path;
}

// Both take a step of the table at 1000 mm/s²; the coarse one starts it up to half a millisecond
// early, which is 22 µm for 44 mm/s in all.
RC_GTEST_PROP(ForecastSpeed, FollowsThePlanThroughDeadTimeScanSlewAndTable, ()) {
  Straight straight(straight_mm(200.0));
  RatioPlan plan;
  plan.start = *rc::gen::elementOf(kTable);
  plan.target = *rc::gen::elementOf(kTable);
  plan.floor = *rc::gen::element(0.1, 0.35);
  RC_PRE(plan.target >= plan.floor);
  plan.hold_s = *number(0.0, 0.03);
  straight.outset.speed_mm_s = plan.start * kFeed_mm_s;
  straight.outset.panel_ratio = 1.2;
  const auto trace = straight.run(plan);
  RC_ASSERT(trace.count > 100U);
  constexpr double kFine_s = kStep_s / 200.0;
  double s = 0.0;
  double v = plan.start * kFeed_mm_s;
  double t = 0.0;
  for (std::size_t i = 0; i < trace.count; ++i) {
    while (t < Straight::time_s(i) - 0.5 * kFine_s) {
      t += kFine_s;
      const double goal = kFeed_mm_s * step_below(ratio_at(plan, t));
      v = std::clamp(goal, v - kAcceleration_mm_s2 * kFine_s, v + kAcceleration_mm_s2 * kFine_s);
      s += v * kFine_s;
    }
    RC_ASSERT(std::abs(trace.position_mm[i] - s) <= 0.022);
  }
}

// The panel's 60 % under a plan that stays at 100 %: 24 mm/s from the first step on.
TEST(ForecastSpeed, StaysUnderThePanel) {
  Straight straight(straight_mm(200.0));
  straight.outset.panel_ratio = 0.6;
  straight.outset.speed_mm_s = 0.6 * kFeed_mm_s;
  const auto trace = straight.run({.start = 1.0, .target = 1.0, .floor = 1.0});
  ASSERT_GT(trace.count, 10U);
  for (std::size_t i = 0; i < trace.count; ++i) {
    ASSERT_NEAR(trace.position_mm[i], 0.6 * kFeed_mm_s * Straight::time_s(i), 1e-9);
  }
}

// From 40 mm/s at 1000 mm/s² to the corner's 5 mm/s: v² ≤ 5² + 2·a·left everywhere before it. After
// that the speed rises by a·t.
TEST(ForecastSpeed, BrakesForTheCornerAheadAndNoSooner) {
  for (const double corner_mm : {1.5, 1.61, 1.9}) {
    PathMaker maker({0, 0, 0}, kFeed_mm_s);
    maker.line_to({corner_mm, 0, 0}).line_to({corner_mm, 50, 0});
    auto path = maker.path();
    path[0].exit_speed_limit_mm_s = 5.0;
    Straight straight(path);
    const auto trace = straight.run({.start = 1.0, .target = 1.0, .floor = 1.0, .hold_s = 0.06});
    double slowest_mm_s = kFeed_mm_s;
    for (std::size_t i = 1; i < trace.count; ++i) {
      const double v = (trace.position_mm[i] - trace.position_mm[i - 1]) / kStep_s;
      const double left_mm = corner_mm - trace.position_mm[i];
      if (left_mm > 0.0) {
        const double allowed = std::sqrt(25.0 + 2.0 * kAcceleration_mm_s2 * left_mm);
        ASSERT_LE(v, std::min(kFeed_mm_s, allowed) + 0.6) << left_mm;
        ASSERT_GE(v, std::min(kFeed_mm_s, allowed) - 0.6) << left_mm;
      }
      slowest_mm_s = std::min(slowest_mm_s, v);
    }
    EXPECT_NEAR(slowest_mm_s, 5.0, 0.7);
  }
}

// A millimetre in feed at 50 %, then another motion, seen while the tool is still in the cut and
// 0.15 mm of the other motion are commanded. Feed continues at 20 mm/s; a rapid at 25 % has braked
// to 10 mm/s; a thread is not scaled and speeds up, v² = 20² + 2·1000·0.15.
TEST(ForecastSpeed, TheFeedOverrideScalesTheFeedAlone) {
  const auto speed_in = [](Motion motion) {
    PathMaker maker({0, 0, 0}, kFeed_mm_s);
    maker.line_to({1.0, 0, 0}).motion(motion).line_to({100, 0, 0});
    Straight straight(maker.path());
    straight.outset.rapid_ratio = 0.25;
    straight.outset.speed_mm_s = 0.5 * kFeed_mm_s;
    const auto trace = straight.run({.start = 0.5, .target = 0.5, .floor = 0.5});
    std::size_t i = 1;
    while (i + 1 < trace.count && trace.position_mm[i] < 1.15) {
      ++i;
    }
    return (trace.position_mm[i] - trace.position_mm[i - 1]) / kStep_s;
  };
  EXPECT_NEAR(speed_in(Motion::feed), 20.0, 1e-6);
  EXPECT_NEAR(speed_in(Motion::rapid), 10.0, 1e-6);
  EXPECT_NEAR(speed_in(Motion::thread), std::sqrt(400.0 + 300.0), 0.5);
}

// The largest step not above the ratio; below the table its lowest.
RC_GTEST_PROP(ForecastTable, RoundsDownToAStep, ()) {
  Forecast forecast;
  forecast.set_table(kTable);
  const double ratio = *rc::gen::inRange(0, 1500) / 1000.0;
  double truth = kTable.front();
  for (const double step : kTable) {
    truth = step <= ratio ? step : truth;
  }
  RC_ASSERT(forecast.floor_ratio(ratio) == truth);
  RC_ASSERT(forecast.floor_ratio(truth - 1e-12) == truth);
}

// A trace is the unavoidable error: along it a candidate may be as bad, but no worse.
TEST(ForecastTrace, RaisesTheLimitWhereItLies) {
  const auto path = PathMaker({10, 0, 0}, kFeed_mm_s).arc({0, 0, 0}, 6.0).path();
  Straight straight(path);
  LookAhead ahead({}, kAcceleration_mm_s2);
  for (int i = 0; i < 20; ++i) {
    ahead.update(path, 0, 0.0, 0.0, 60.0);
  }
  Forecast forecast;
  forecast.set_timing(timing());
  forecast.set_model(std::array{AxisModel{}, AxisModel{}, AxisModel{}});
  forecast.set_table(kTable);
  forecast.pending().fill(1.0);
  forecast.set_pending_count(40);
  const RatioPlan plan{.start = 1.0, .target = 1.0, .floor = 1.0, .hold_s = 0.1};
  Forecast::Trace trace;
  const auto free = forecast.run(ahead, straight.outset, plan, 1e9, false, nullptr, &trace);
  ASSERT_GT(free.error_mm, 0.02);
  const auto kept_with = [&](double share) {
    Forecast::Trace raised = trace;
    for (std::size_t i = 0; i < raised.count; ++i) {
      raised.error_mm[i] *= share;
    }
    return forecast.run(ahead, straight.outset, plan, 1e-6, true, &raised, nullptr).kept;
  };
  EXPECT_TRUE(kept_with(1.001));
  EXPECT_FALSE(kept_with(0.999));
}

}  // namespace
}  // namespace steadyrest::contour::online
