// SPDX-License-Identifier: Apache-2.0
#include <cmath>
#include <limits>
#include <string>
#include <vector>

#include <gtest/gtest.h>
#include <rapidcheck/gtest.h>

#include <steadyrest/contour/online/feed_governor.hpp>
#include <steadyrest/contour/online/test/closed_form.hpp>
#include <steadyrest/contour/online/test/closed_loop.hpp>
#include <steadyrest/contour/online/test/paths.hpp>
#include <steadyrest/kernel/rt/testing/allocation_guard.hpp>
#include <steadyrest/math/geometry/test/segments.hpp>

namespace steadyrest::contour::online {
namespace {

using kernel::machine::ContourStrategy;
using kernel::outcome::Reason;
using kernel::signal::Motion;
using math::geometry::test::number;
using test::closed_form_mm;
using test::ClosedLoop;
using test::kTurn;
using test::largest_step;
using test::LoopResult;
using test::LoopSample;
using test::Machine;
using test::PathMaker;
using test::PathSegment;
using test::pocket;

/// Nothing of the layer is in force.
constexpr kernel::signal::InForce kAtPanel{};

std::vector<PathSegment> circle(double radius, double feed_mm_min, double turns) {
  return PathMaker({radius, 0, 0}, feed_mm_min / 60.0)
      .arc({0, 0, 0}, turns * kTurn)
      .limited(2000.0, 1.0);
}

TEST(FeedGovernor, HoldsTenMicrometresOnTheCircleOfThePaperWithTheLargestStep) {
  const Machine machine = test::mill(50.0);
  const auto path = circle(10.0, 4000.0, 4.0);
  ClosedLoop loop(machine, path);
  const LoopResult result = loop.run(0.010, 0.5, 10.0);
  EXPECT_EQ(result.over_limit_share, 0.0);
  EXPECT_EQ(result.changes, 0);
  EXPECT_NEAR(result.sample.back().effective, 0.30, 1e-12);
  EXPECT_NEAR(result.sample.back().error_mm, 0.0080, 0.0001);
  EXPECT_NEAR(result.sample.back().output.predicted_error_mm, 0.0080, 0.0002);
}

RC_GTEST_PROP(FeedGovernor, OnAnyCircleTakesTheLargestStepOfTheClosedForm, ()) {
  Machine machine = test::mill(*number(25.0, 90.0));
  const double feed_forward = *rc::gen::element(0.0, 0.3, 0.6);
  for (auto& axis : machine.axes) {
    axis.feed_forward = feed_forward;
  }
  if (*rc::gen::arbitrary<bool>()) {
    machine.feed_override.ratio = test::dmg_31();
  }
  machine.control.interpolator_period_s = *rc::gen::element(0.001, 0.002, 0.004);
  const double radius = *number(3.0, 40.0);
  const double feed = *number(10.0, 80.0);
  machine.contour.min_ratio = 0.05;
  const double limit = machine.contour.limit_mm * (1.0 - machine.contour.margin);
  const double expected = largest_step(machine, radius, feed, limit);
  // Cases in which the step lies on the knife's edge are not decided by the closed form.
  RC_PRE(largest_step(machine, radius, feed, 0.96 * limit) == expected);
  RC_PRE(largest_step(machine, radius, feed, 1.04 * limit) == expected);
  RC_PRE(closed_form_mm(radius, expected * feed, machine.axes[0].servo_gain_1_s,
                        machine.axes[0].feed_forward) < limit);
  const double speed = std::min(expected * feed, std::sqrt(2000.0 * radius));
  const auto path = circle(radius, feed * 60.0, 2.5 * speed / (kTurn * radius) + 0.5);
  ClosedLoop loop(machine, path);
  const LoopResult result = loop.run(machine.contour.limit_mm, 1.0, 2.0);
  RC_ASSERT(result.sample.back().effective == expected);
  RC_ASSERT(result.changes == 0);
  RC_ASSERT(result.over_limit_share == 0.0);
}

struct Row {
  ContourStrategy strategy;
  double weight_contour;
  double target_mm;
  double step;
  double error_mm;
  Reason reason;
};

class Strategies : public testing::TestWithParam<Row> {};

// R = 10 mm, F4000, k = 50 1/s, ε_max = 10 µm; errors by the closed form.
TEST_P(Strategies, TakeTheirOwnStepOnTheCircleOfThePaper) {
  const Row& row = GetParam();
  Machine machine = test::mill(50.0);
  machine.contour.strategy = row.strategy;
  machine.contour.weight_contour = row.weight_contour;
  machine.contour.weight_feed = 1.0 - row.weight_contour;
  machine.contour.target_mm = row.target_mm;
  const auto path = circle(10.0, 4000.0, 4.0);
  ClosedLoop loop(machine, path);
  const LoopResult result = loop.run(0.010, 0.8, 6.0);
  EXPECT_DOUBLE_EQ(result.sample.back().effective, row.step);
  EXPECT_NEAR(result.sample.back().error_mm, row.error_mm, 1e-4);
  EXPECT_EQ(result.sample.back().output.request.reason, row.reason);
  EXPECT_EQ(result.changes, 0);
  EXPECT_EQ(result.over_limit_share, 0.0);
}

INSTANTIATE_TEST_SUITE_P(
    Paper, Strategies,
    testing::Values(
        // Least error: the lowest permitted step.
        Row{ContourStrategy::contour_priority, 0.5, 0.0, 0.10, 0.0009, Reason::contour_objective},
        // Errors up to 5 µm count as equal: the fastest of them.
        Row{ContourStrategy::contour_priority, 0.5, 0.005, 0.20, 0.0036, Reason::contour_objective},
        // w1 = 0.25: v* = w2·ε_max/(2·w1·c·(v_max − v_min)) = 0.188·v_max, of the steps 20 %.
        Row{ContourStrategy::combined, 0.25, 0.0, 0.20, 0.0036, Reason::contour_objective},
        // Largest step within the limit.
        Row{ContourStrategy::feed_priority, 0.5, 0.0, 0.30, 0.0080, Reason::contour_within_limit}));

TEST(FeedGovernor, AnotherObjectiveCanBePutIn) {
  FeedGovernor::Config config = FeedGovernor::Config::of(test::mill(50.0));
  config.contour.strategy = ContourStrategy::combined;
  config.objective = [](const Candidate& c) noexcept { return std::abs(c.ratio - 0.2); };
  FeedGovernor governor = FeedGovernor::make(config).value();
  const auto path = circle(10.0, 4000.0, 4.0);
  kernel::signal::Frame frame;
  frame.path = path;
  frame.motion = Motion::feed;
  frame.programmed_feed_mm_s = 66.67;
  frame.axis[0].command_mm = frame.axis[0].actual_mm = 10.0;
  EXPECT_LE(governor.update(frame, kAtPanel).request.ratio, 0.2);
}

TEST(FeedGovernor, AWrongPassportIsOvercomeWithinASecond) {
  const Machine truth = test::mill(42.0);
  const Machine passport = test::mill(50.0);
  const auto path = circle(10.0, 4000.0, 6.0);
  ClosedLoop loop(truth, passport, path);
  const LoopResult result = loop.run(0.010, 1.0, 10.0);
  EXPECT_NEAR(loop.governor().servo_model().axis(0).gain_1_s, 42.0, 0.5);
  EXPECT_EQ(result.over_limit_share, 0.0);
  EXPECT_DOUBLE_EQ(result.sample.back().effective,
                   largest_step(truth, 10.0, 4000.0 / 60.0, 0.0095));
}

TEST(FeedGovernor, UnequalGainsKeepTheLimitToo) {
  Machine machine = test::mill(50.0);
  machine.axes[1].servo_gain_1_s = 55.0;
  machine.contour.limit_mm = 0.030;
  const auto path = circle(10.0, 4000.0, 6.0);
  ClosedLoop loop(machine, path);
  const LoopResult result = loop.run(0.030, 1.0, 10.0);
  EXPECT_EQ(result.over_limit_share, 0.0);
  // v²/(2Rk²) + v/2·|1/kx − 1/ky|: 0.0245 at 40 % (of 0.0285 permitted), 0.0515 at 60 %.
  EXPECT_GE(result.sample.back().effective, 0.30);
  EXPECT_GT(result.largest_mm, 0.020);
}

TEST(FeedGovernor, OversizeByTheVelocityLoopCountsLikeUndersize) {
  // k·τ = 0.75: ε ≈ (1 − 2kτ)·v²/(2Rk²) is negative.
  Machine machine = test::mill(50.0);
  for (auto& axis : machine.axes) {
    axis.velocity_lag_s = 0.015;
  }
  const auto path = circle(10.0, 4000.0, 6.0);
  ClosedLoop loop(machine, path);
  const LoopResult result = loop.run(0.010, 1.0, 10.0);
  EXPECT_LT(result.sample.back().error_mm, -0.004);
  EXPECT_LT(result.sample.back().output.predicted_error_mm, -0.004);
  EXPECT_EQ(result.over_limit_share, 0.0);
}

TEST(FeedGovernor, ChangesAtMostOnceInHalfASecondOfSteadyStateInSpiteOfNoise) {
  const Machine machine = test::mill(50.0);
  const auto path = circle(10.0, 4000.0, 8.0);
  ClosedLoop loop(machine, path);
  std::uint32_t noise = 7;
  loop.disturb = [&](kernel::signal::Frame& frame) {
    for (std::size_t i = 0; i < 3; ++i) {
      noise = noise * 1664525u + 1013904223u;
      frame.axis[i].actual_mm += 1e-3 * (static_cast<double>(noise >> 8) / 16777216.0 - 0.5);
    }
  };
  const LoopResult result = loop.run(0.010, 1.0, 20.0);
  double last_change_s = 0.0;
  for (std::size_t i = 1; i < result.sample.size(); ++i) {
    if (result.sample[i].time_s > 1.0 &&
        result.sample[i].effective != result.sample[i - 1].effective) {
      EXPECT_GE(result.sample[i].time_s - last_change_s, 0.5);
      last_change_s = result.sample[i].time_s;
    }
  }
  EXPECT_EQ(result.over_limit_share, 0.0);
}

TEST(FeedGovernor, WithoutAPathItKeepsTheLimitOfASteadyArc) {
  const Machine machine = test::mill(50.0);
  const auto path = circle(10.0, 4000.0, 6.0);
  ClosedLoop loop(machine, path);
  loop.show_path = false;
  const LoopResult result = loop.run(0.010, 1.5, 10.0);
  EXPECT_EQ(result.over_limit_share, 0.0);
  EXPECT_DOUBLE_EQ(result.sample.back().effective, 0.30);
  EXPECT_EQ(result.sample.back().output.request.reason, Reason::contour_path_unknown);
}

TEST(FeedGovernor, SaysSoWhenEvenTheLowestStepDoesNotKeepTheLimit) {
  Machine machine = test::mill(20.0);
  machine.contour.min_ratio = 0.5;
  const auto path = circle(3.0, 3000.0, 20.0);
  ClosedLoop loop(machine, path);
  const LoopResult result = loop.run(0.010, 1.0, 2.0);
  EXPECT_DOUBLE_EQ(result.sample.back().effective, 0.5);
  EXPECT_EQ(result.sample.back().output.request.reason, Reason::contour_feed_floor);
}

TEST(FeedGovernor, SaysSoWhenTheOverrideDoesNotMoveTheFeed) {
  const Machine machine = test::mill(50.0);
  auto path = circle(40.0, 4000.0, 4.0);
  path[0].speed_limit_mm_s = 12.0;
  ClosedLoop loop(machine, path);
  const LoopResult result = loop.run(0.010, 1.0, 4.0);
  EXPECT_EQ(result.sample.back().output.request.reason, Reason::contour_no_effect);
  EXPECT_EQ(result.over_limit_share, 0.0);
}

TEST(FeedGovernor, TheOperatorsPanelIsNotExceededAndDoesNotWindUp) {
  const Machine machine = test::mill(50.0);
  const auto path = circle(10.0, 4000.0, 8.0);
  ClosedLoop loop(machine, path);
  loop.panel = 0.2;
  loop.run(0.010, 0.0, 3.0);
  loop.panel = 1.0;
  const LoopResult result = loop.run(0.010, 3.0, 8.0);
  EXPECT_EQ(result.over_limit_share, 0.0);
  EXPECT_DOUBLE_EQ(result.sample.back().effective, 0.30);
}

// Another room, an operator or a thread has held the override at 20 %; nothing that was asked for
// has come through. The plan begins there, and goes no higher than the slew can within a decision.
TEST(FeedGovernor, PlansFromWhatTheEnvelopeHasLetThroughNotFromWhatItAskedFor) {
  const Machine machine = test::mill(50.0);
  const auto path = circle(60.0, 2000.0, 1.0);
  ClosedLoop loop(machine, path);
  loop.with_layer = false;
  FeedGovernor free = FeedGovernor::make(machine).value();
  FeedGovernor held = FeedGovernor::make(machine).value();
  const kernel::signal::InForce at_20{.feed = {.ratio = 0.2, .word_ratio = 0.2}, .written = true};
  FeedGovernor::Output of_free;
  FeedGovernor::Output of_held;
  loop.disturb = [&](kernel::signal::Frame& frame) {
    of_free = free.update(frame, kAtPanel);
    of_held = held.update(frame, at_20);
  };
  while (loop.step().time_s < 1.0) {
  }
  EXPECT_EQ(held.course().in_force_ratio, 0.2);
  EXPECT_EQ(of_free.request.ratio, 1.0);
  EXPECT_EQ(of_held.request.ratio, 0.3) << "the next step above 20 % + 2 1/s * 10 ms";
}

TEST(FeedGovernor, ARestoredStateGoesOnAsItWouldHave) {
  const Machine machine = test::mill(50.0);
  const auto path = pocket(4000.0 / 60.0);
  ClosedLoop loop(machine, path);
  FeedGovernor first = FeedGovernor::make(machine).value();
  FeedGovernor second = FeedGovernor::make(machine).value();
  std::size_t cycle = 0;
  loop.disturb = [&](kernel::signal::Frame& frame) {
    const auto a = first.update(frame, loop.in_force());
    if (++cycle == 1500) {
      second.restore(first.state());
    } else if (cycle > 1500) {
      const auto b = second.update(frame, loop.in_force());
      ASSERT_EQ(a.request.ratio, b.request.ratio);
      ASSERT_EQ(a.request.reason, b.request.reason);
      ASSERT_EQ(a.error_mm, b.error_mm);
      ASSERT_EQ(a.predicted_error_mm, b.predicted_error_mm);
      ASSERT_EQ(a.predicted_at_mm, b.predicted_at_mm);
      ASSERT_EQ(a.forecast_steps, b.forecast_steps);
    }
  };
  while (loop.step().time_s < 6.0) {
  }
  EXPECT_GT(cycle, 1500U);
}

kernel::signal::Frame cutting_frame(const std::vector<PathSegment>& path) {
  kernel::signal::Frame frame;
  frame.path = path;
  frame.motion = Motion::feed;
  frame.programmed_feed_mm_s = path[0].feed_mm_s;
  frame.path_speed_mm_s = path[0].feed_mm_s;
  for (std::size_t i = 0; i < 3; ++i) {
    frame.axis[i].command_mm = frame.axis[i].actual_mm = path[0].start_mm[i];
  }
  return frame;
}

TEST(FeedGovernor, WithdrawsInThreadingTappingAndRapids) {
  const auto path = circle(10.0, 4000.0, 4.0);
  FeedGovernor governor = FeedGovernor::make(test::mill(50.0)).value();
  auto frame = cutting_frame(path);
  EXPECT_LT(governor.update(frame, kAtPanel).request.ratio, 1.0);
  for (const Motion motion : {Motion::thread, Motion::tap}) {
    frame.time_s += 0.001;
    frame.motion = motion;
    const auto output = governor.update(frame, kAtPanel);
    EXPECT_EQ(output.request.ratio, 1.0);
    EXPECT_EQ(output.request.reason, Reason::withdrawn_thread);
  }
  frame.time_s += 0.001;
  frame.motion = Motion::rapid;
  frame.path = {};
  EXPECT_EQ(governor.update(frame, kAtPanel).request.reason, Reason::not_cutting);
  EXPECT_EQ(governor.update(frame, kAtPanel).request.ratio, 1.0);
}

TEST(FeedGovernor, IsReadyBeforeTheRapidEnds) {
  // A long rapid, then an arc at once: the step must stand when the cut begins.
  const Machine machine = test::mill(50.0);
  auto path = PathMaker({-200, -10, 0}, 150.0)
                  .motion(Motion::rapid)
                  .line_to({0, -10, 0})
                  .motion(Motion::feed)
                  .feed(4000.0 / 60.0)
                  .arc({0, 0, 0}, 2 * kTurn)
                  .limited(2000.0, 5.0);
  path[0].exit_speed_limit_mm_s = 0.0;
  ClosedLoop loop(machine, path);
  const LoopResult result = loop.run(0.010);
  EXPECT_EQ(result.over_limit_share, 0.0);
  EXPECT_EQ(result.sample[200].output.request.reason, Reason::not_cutting);
}

TEST(FeedGovernor, WithdrawsWhenInputIsNotFiniteOrStale) {
  const auto path = circle(10.0, 4000.0, 4.0);
  FeedGovernor governor = FeedGovernor::make(test::mill(50.0)).value();
  const double nan = std::numeric_limits<double>::quiet_NaN();
  auto frame = cutting_frame(path);
  governor.update(frame, kAtPanel);
  for (double* field : {&frame.axis[1].actual_mm, &frame.axis[0].command_mm, &frame.path_speed_mm_s,
                        &frame.feed.effective_ratio, &frame.time_s}) {
    const double kept = *field;
    *field = nan;
    const auto output = governor.update(frame, kAtPanel);
    EXPECT_EQ(output.request.ratio, 1.0);
    EXPECT_EQ(output.request.reason, Reason::input_not_finite);
    *field = kept;
  }
  frame.time_s += 0.001;
  frame.age_s = 1.0;
  EXPECT_EQ(governor.update(frame, kAtPanel).request.reason, Reason::input_stale);
  frame.age_s = 0.0;
  frame.time_s += 0.001;
  EXPECT_LT(governor.update(frame, kAtPanel).request.ratio, 1.0);
}

TEST(FeedGovernor, DoesNotAllocateAfterConstruction) {
  Machine machine = test::mill(50.0);
  machine.contour.strategy = ContourStrategy::combined;
  const auto path = pocket(50.0);
  ClosedLoop recorder(machine, path);
  std::vector<kernel::signal::Frame> frames;
  frames.reserve(20000);
  recorder.disturb = [&](kernel::signal::Frame& frame) { frames.push_back(frame); };
  recorder.run(0.010, 0.0, 10.0);
  FeedGovernor governor = FeedGovernor::make(machine).value();
  const kernel::rt::testing::AllocationGuard guard;
  for (auto& frame : frames) {
    governor.update(frame, kAtPanel);
  }
  for (auto& frame : frames) {
    frame.path = {};
    governor.update(frame, kAtPanel);
  }
}

TEST(FeedGovernor, RefusesWhatIsOutsideOfItsRange) {
  Machine machine = test::mill(50.0);
  machine.contour.limit_mm = 0.0;
  EXPECT_FALSE(FeedGovernor::make(machine).has_value());
  machine = test::mill(50.0);
  machine.contour.min_ratio = 0.41;
  machine.contour.max_ratio = 0.49;
  EXPECT_FALSE(FeedGovernor::make(machine).has_value());
  machine = test::mill(50.0);
  machine.axes.clear();
  EXPECT_FALSE(FeedGovernor::make(machine).has_value());
}

}  // namespace
}  // namespace steadyrest::contour::online
