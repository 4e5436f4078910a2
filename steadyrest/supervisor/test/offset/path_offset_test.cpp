// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <cmath>

#include <gtest/gtest.h>

#include <steadyrest/kernel/rt/testing/allocation_guard.hpp>
#include <steadyrest/kernel/units/constants.hpp>
#include <steadyrest/supervisor/test/circle.hpp>

// Offsets that cancel the contour error: R = 10 mm at F4000 and k = 50 1/s is 88 µm undersize
// without them (closed form in contour_room_test.cpp).
namespace steadyrest::supervisor {
namespace {

namespace signal = kernel::signal;
using kernel::machine::Mode;
using kernel::outcome::Reason;
using test::Circle;
using test::kCycle_s;

constexpr double kMost_mm = 0.5;
constexpr double kWithout_mm = 0.0877;

kernel::machine::Machine cancelling(Mode mode) {
  auto machine = test::lagging_mill(mode, true);
  machine.envelope.max_path_offset_mm = kMost_mm;
  return machine;
}

Circle circle_in(Mode mode, bool port_takes_offsets = true) {
  return Circle(cancelling(mode), {.feed_override = true, .path_offset = port_takes_offsets});
}

double size(const signal::AxisValues& offset_mm) {
  return std::hypot(offset_mm[0], offset_mm[1]);
}

// c′ runs on R·√(1 + q²), q = 4/30: the offset is R·√(1 + q²) less the circle of the command, both
// under the lag's angle. By hand: |c′ − c| with c′ = 10.0885·e^{i(φ−q+atan q)}, c = 10·e^{iφ}:
// 0.089.
TEST(PathOffset, KeepsTheToolOnTheCircleAtFullFeed) {
  Circle circle = circle_in(Mode::act);
  const auto command = circle.run(3.0);
  EXPECT_EQ(command.feed_ratio, 1.0);
  EXPECT_LT(std::abs(circle.true_error_mm()), 0.0005);
  EXPECT_EQ(command.path_offset_reason, Reason::contour_cancelled);
  EXPECT_NEAR(size(command.path_offset_mm), 0.089, 0.001);
  EXPECT_EQ(size(command.offset_mm), 0.0) << "that one is against heat";
}

// 0.2 s from nothing to its full size, 200 cycles: no step in the part where it begins in the cut.
TEST(PathOffset, GrowsWhereItBeginsInTheCut) {
  auto machine = cancelling(Mode::observe);
  machine.contour.limit_mm = 1.0;  // the feed stays where it is
  Circle circle(machine, {.feed_override = true, .path_offset = true});
  circle.run(1.0);
  circle.supervisor.set_mode(Mode::act);
  double before_mm = 0.0;
  for (int cycle = 0; cycle < 400; ++cycle) {
    const double now_mm = size(circle.cycle().path_offset_mm);
    EXPECT_LT(std::abs(now_mm - before_mm), 0.089 / 200.0 * 1.1) << cycle;
    before_mm = now_mm;
  }
  EXPECT_NEAR(before_mm, 0.089, 0.001);
}

TEST(PathOffset, IsNotWrittenInObserveAndShownInAdvise) {
  Circle observed = circle_in(Mode::observe);
  EXPECT_EQ(size(observed.run(3.0).path_offset_mm), 0.0);
  EXPECT_NEAR(observed.true_error_mm(), kWithout_mm, 0.01 * kWithout_mm);
  Circle advised = circle_in(Mode::advise);
  const auto command = advised.run(3.0);
  EXPECT_FALSE(command.write);
  EXPECT_NEAR(size(command.path_offset_mm), 0.089, 0.001);
  EXPECT_NEAR(advised.true_error_mm(), kWithout_mm, 0.01 * kWithout_mm);
}

// The feed override is what is left: 30 %, as without offsets.
TEST(PathOffset, APortWithoutThemGetsTheFeedOverride) {
  Circle circle = circle_in(Mode::act, false);
  const auto command = circle.run(5.0);
  EXPECT_EQ(command.feed_ratio, 0.30);
  EXPECT_EQ(size(command.path_offset_mm), 0.0);
  EXPECT_LE(circle.true_error_mm(), 0.010);
}

// How the port moves an offset counts only where one can be asked for.
TEST(PathOffset, WithoutOneItsDelayAndAccelerationChangeNoDecision) {
  kernel::port::Capability slow{
      .feed_override = true, .path_offset_delay_s = 1.0, .path_offset_acceleration_mm_s2 = 400.0};
  auto machine = cancelling(Mode::act);
  for (const bool port_takes_offsets : {false, true}) {
    slow.path_offset = port_takes_offsets;
    machine.envelope.max_path_offset_mm = port_takes_offsets ? 0.0 : kMost_mm;
    ASSERT_TRUE(Supervisor::make(machine, slow)) << port_takes_offsets;
    Circle circle(machine, slow);
    Circle plain(machine, {.feed_override = true});
    for (int cycle = 0; cycle < 500; ++cycle) {
      circle.cycle();
      plain.cycle();
      ASSERT_EQ(circle.supervisor.estimates().contour->predicted_error_mm,
                plain.supervisor.estimates().contour->predicted_error_mm)
          << cycle;
    }
  }
}

/// Runs until nothing is left of the offset, at most a second; the steps must stay below the fade's
/// 0.5 mm in 0.2 s.
void expect_ramps_out(Circle& circle) {
  double before_mm = size(circle.cycle().path_offset_mm);
  double time_s = 0.0;
  for (; before_mm > 0.0 && time_s < 1.0; time_s += kCycle_s) {
    const double now_mm = size(circle.cycle().path_offset_mm);
    EXPECT_LE(before_mm - now_mm, std::sqrt(2.0) * kMost_mm / 0.2 * kCycle_s + 1e-9);
    before_mm = now_mm;
  }
  EXPECT_LT(time_s, 0.2) << "gone within the fade's time";
}

// Frozen, it would be as wrong on the other side of the circle as it was right here.
TEST(PathOffset, RampsOutInTheCutWhereTheInputIsUnfit) {
  Circle circle = circle_in(Mode::act);
  circle.run(1.0);
  circle.frame.axis[0].velocity_mm_s = kernel::units::kNan;
  circle.frame.programmed_feed_mm_s = kernel::units::kNan;
  expect_ramps_out(circle);
}

TEST(PathOffset, RampsOutInAThreadAndWithoutAPath) {
  Circle threading = circle_in(Mode::act);
  threading.run(1.0);
  threading.frame.motion = signal::Motion::thread;
  expect_ramps_out(threading);
  Circle lost = circle_in(Mode::act);
  lost.run(1.0);
  lost.frame.path = {};
  expect_ramps_out(lost);
}

// Leaving act: the mode changes only once nothing of the layer is on the machine.
TEST(PathOffset, IsGoneBeforeActIsLeft) {
  Circle circle = circle_in(Mode::act);
  circle.run(1.0);
  circle.supervisor.set_mode(Mode::observe);
  const double last_mm = size(circle.run(0.02).path_offset_mm);
  EXPECT_GT(last_mm, 0.0);
  EXPECT_EQ(circle.supervisor.mode_in_force(), Mode::act);
  circle.run(1.0);
  EXPECT_EQ(circle.supervisor.mode_in_force(), Mode::observe);
}

// After a restart in the cut the cells, the servo model and the offsets begin again.
TEST(PathOffset, BeginsAgainAfterAnInterruption) {
  Circle circle = circle_in(Mode::act);
  circle.run(1.0);
  const auto state = circle.supervisor.state();
  EXPECT_NEAR(size(state.path_offset.offset_mm), 0.089, 0.001);
  circle.supervisor.restore(state);
  const auto command = circle.run(3.0);
  EXPECT_LT(std::abs(circle.true_error_mm()), 0.0005);
  EXPECT_EQ(command.path_offset_reason, Reason::contour_cancelled);
}

// The same deal as for heat: what the port refused is not on the machine.
TEST(PathOffset, IsTakenBackWhenItWasNotDelivered) {
  Circle circle = circle_in(Mode::act);
  circle.run(1.0);
  const auto before = circle.supervisor.in_force().path_offset_mm;
  circle.cycle();
  circle.supervisor.not_delivered();
  EXPECT_EQ(circle.supervisor.in_force().path_offset_mm, before);
}

TEST(PathOffset, ACycleWithItAllocatesNothing) {
  Circle circle = circle_in(Mode::act);
  circle.run(0.5);
  const kernel::rt::testing::AllocationGuard guard;
  circle.run(0.5);
}

}  // namespace
}  // namespace steadyrest::supervisor
