// SPDX-License-Identifier: Apache-2.0
#include <limits>
#include <vector>

#include <gtest/gtest.h>

#include <steadyrest/contour/online/feed_governor.hpp>
#include <steadyrest/contour/online/test/closed_loop.hpp>
#include <steadyrest/contour/online/test/paths.hpp>
#include <steadyrest/math/geometry/test/segments.hpp>

namespace steadyrest::contour::online {
namespace {

using kernel::outcome::Reason;
using kernel::signal::Motion;
using test::circle;
using test::ClosedLoop;
using test::kAtPanel;
using test::kTurn;
using test::LoopResult;
using test::Machine;
using test::PathMaker;
using test::PathSegment;

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

// Another room, an operator or a thread has held the override at 20 %; nothing that the governor
// asked for took effect. The plan starts there, and goes no higher than the slew can within a
// decision.
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
  // A long rapid, then an arc at once: the step must be in force when the cut begins.
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

// Without the reason given the same frame would be acted on.
TEST(FeedGovernor, AFrameThatTheSupervisorFindsUnfitIsNotActedOn) {
  auto governor = *FeedGovernor::make(test::mill(50.0));
  kernel::signal::Frame frame;
  frame.motion = Motion::feed;
  frame.time_s = 1.0;
  EXPECT_EQ(governor.update(frame, {}, Reason::input_out_of_range).request.reason,
            Reason::input_out_of_range);
  frame.time_s = 1.001;
  EXPECT_NE(governor.update(frame, {}).request.reason, Reason::input_out_of_range);
}

}  // namespace
}  // namespace steadyrest::contour::online
