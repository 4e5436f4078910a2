// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <cmath>
#include <cstddef>
#include <optional>
#include <vector>

#include <gtest/gtest.h>

#include <steadyrest/contour/online/feed_governor.hpp>
#include <steadyrest/contour/online/test/closed_form.hpp>
#include <steadyrest/contour/online/test/closed_loop.hpp>
#include <steadyrest/contour/online/test/paths.hpp>
#include <steadyrest/kernel/rt/testing/allocation_guard.hpp>

namespace steadyrest::contour::online {
namespace {

using kernel::outcome::Reason;
using kernel::signal::Frame;
using test::circle;
using test::closed_form_mm;
using test::ClosedLoop;
using test::LoopSample;
using test::Machine;
using test::pocket;
using Look = FeedGovernor::Look;

/// A loop that keeps the frame its governor was shown.
class Shown {
 public:
  Shown(const Machine& machine, kernel::signal::PathView path) : loop(machine, path) {
    loop.disturb = [this](Frame& of) { frame = of; };
  }
  LoopSample step() { return loop.step(); }
  std::optional<double> preview(double ratio, Look look) {
    return loop.governor().preview(frame, ratio, look);
  }
  ClosedLoop loop;
  Frame frame;
};

// R 10 mm at F4000 and 50 1/s: 30 % is in force, with 8 µm.
TEST(FeedGovernorPreview, HeldGivesTheClosedFormOfEachStepOnACircle) {
  const Machine machine = test::mill(50.0);
  const auto path = circle(10.0, 4000.0, 4.0);
  Shown shown(machine, path);
  while (shown.step().time_s < 1.0) {
  }
  std::size_t seen = 0;
  for (const double ratio : shown.loop.governor().steps()) {
    const auto held = shown.preview(ratio, Look::held);
    ASSERT_TRUE(held.has_value()) << ratio;
    // Above 2.1 m/s² across the path the axes' 2 m/s² caps the speed, not the override.
    const double speed = std::min(ratio * 4000.0 / 60.0, std::sqrt(2000.0 * 10.0));
    const double truth = closed_form_mm(10.0, speed, 50.0, 0.0);
    EXPECT_NEAR(*held, truth, 2e-4 + 0.01 * truth) << ratio;
    ++seen;
  }
  EXPECT_EQ(seen, 23U);
}

TEST(FeedGovernorPreview, HeldLooksBeyondThePanelAndChangeDoesNot) {
  const Machine machine = test::mill(50.0);
  const auto path = circle(10.0, 4000.0, 4.0);
  Shown shown(machine, path);
  shown.loop.panel = 0.2;
  while (shown.step().time_s < 1.0) {
  }
  EXPECT_NEAR(*shown.preview(0.4, Look::held), closed_form_mm(10.0, 0.4 * 4000.0 / 60.0, 50.0, 0.0),
              3e-4);
  EXPECT_NEAR(*shown.preview(0.4, Look::change),
              closed_form_mm(10.0, 0.2 * 4000.0 / 60.0, 50.0, 0.0), 2e-4);
}

// Of every decision in the pocket, some of which not even the fall satisfies.
TEST(FeedGovernorPreview, OfTheChosenStepIsTheGovernorsOwnPrediction) {
  const Machine machine = test::mill(50.0);
  const auto path = pocket(60.0);
  Shown shown(machine, path);
  std::size_t chosen = 0;
  std::size_t floors = 0;
  while (!shown.loop.done()) {
    const LoopSample now = shown.step();
    if (!now.output.decided) {
      continue;
    }
    const auto error = shown.preview(now.output.request.ratio, Look::change);
    if (!error) {
      EXPECT_EQ(now.output.predicted_error_mm, 0.0) << now.time_s;
      continue;
    }
    EXPECT_EQ(*error, now.output.predicted_error_mm) << now.time_s;
    ++chosen;
    floors += now.output.request.reason == Reason::contour_feed_floor ? 1 : 0;
  }
  EXPECT_GT(chosen, 1000U);
  EXPECT_GT(floors, 10U);
}

/// All that a loop's governor has decided.
std::vector<FeedGovernor::Output> outputs(const Machine& machine, bool watched) {
  const auto path = pocket(60.0);
  Shown shown(machine, path);
  std::vector<FeedGovernor::Output> all;
  std::size_t turn = 0;
  while (all.size() < 20'000 && !shown.loop.done()) {
    all.push_back(shown.step().output);
    if (watched) {
      const auto steps = shown.loop.governor().steps();
      for (const Look look : {Look::change, Look::held}) {
        (void)shown.preview(steps[turn++ % steps.size()], look);
      }
    }
  }
  return all;
}

TEST(FeedGovernorPreview, LeavesEveryDecisionAsItIs) {
  for (const double acceleration : {0.0, 400.0}) {
    Machine machine = test::mill(50.0);
    machine.envelope.max_path_offset_mm = acceleration > 0.0 ? 0.05 : 0.0;
    const auto without = outputs(machine, false);
    const auto with = outputs(machine, true);
    ASSERT_EQ(without.size(), with.size());
    for (std::size_t i = 0; i < with.size(); ++i) {
      ASSERT_EQ(without[i].request.ratio, with[i].request.ratio) << i;
      ASSERT_EQ(without[i].request.reason, with[i].request.reason) << i;
      ASSERT_EQ(without[i].predicted_error_mm, with[i].predicted_error_mm) << i;
      ASSERT_EQ(without[i].predicted_at_mm, with[i].predicted_at_mm) << i;
      ASSERT_EQ(without[i].limit_mm, with[i].limit_mm) << i;
      ASSERT_EQ(without[i].forecast_steps, with[i].forecast_steps) << i;
      ASSERT_EQ(without[i].path_offset.offset_mm, with[i].path_offset.offset_mm) << i;
    }
  }
}

TEST(FeedGovernorPreview, IsEmptyWhereNoPathIsKnownAndOutsideTheCut) {
  const Machine machine = test::mill(50.0);
  const auto path = circle(10.0, 4000.0, 4.0);
  Shown shown(machine, path);
  EXPECT_FALSE(shown.loop.governor().previews());
  shown.loop.show_path = false;
  while (shown.step().time_s < 0.5) {
  }
  EXPECT_TRUE(shown.loop.governor().course().engaged);
  EXPECT_FALSE(shown.loop.governor().previews());
  EXPECT_FALSE(shown.preview(0.5, Look::held));
  shown.loop.show_path = true;
  shown.step();
  EXPECT_TRUE(shown.preview(0.5, Look::held));
  shown.loop.disturb = [&](Frame& of) {
    of.motion = kernel::signal::Motion::idle;
    shown.frame = of;
  };
  shown.step();
  EXPECT_FALSE(shown.preview(0.5, Look::change));
}

TEST(FeedGovernorPreview, AllocatesNothing) {
  const Machine machine = test::mill(50.0);
  const auto path = circle(10.0, 4000.0, 1.0);
  Shown shown(machine, path);
  while (shown.step().time_s < 0.3) {
  }
  const kernel::rt::testing::AllocationGuard guard;
  (void)shown.preview(0.5, Look::held);
  (void)shown.preview(0.5, Look::change);
  EXPECT_EQ(guard.allocations(), 0U);
}

}  // namespace
}  // namespace steadyrest::contour::online
