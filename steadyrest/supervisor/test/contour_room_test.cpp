// SPDX-License-Identifier: Apache-2.0
#include <cmath>

#include <gtest/gtest.h>

#include <steadyrest/kernel/rt/testing/allocation_guard.hpp>
#include <steadyrest/supervisor/test/circle.hpp>

namespace steadyrest::supervisor {
namespace {

using kernel::machine::Mode;
using kernel::outcome::Reason;

using test::Circle;
using test::lagging_mill;

TEST(ContourRoom, WithoutTheLayerTheCircleIsSmallerByTheClosedForm) {
  // ε = R·(1 − 1/√(1 + q²)), q = v/(R·k): 0.0877 mm.
  Circle circle(lagging_mill(Mode::observe, true));
  circle.run(3.0);
  EXPECT_NEAR(circle.true_error_mm(), 0.0877, 0.0877 * 0.01);
  ASSERT_TRUE(circle.supervisor.estimates().contour);
  EXPECT_NEAR(std::abs(circle.supervisor.estimates().contour->error_mm), 0.0877, 0.0877 * 0.01)
      << "observe still estimates";
}

// 4000 mm/min = 66.7 mm/s and k = 50/s: q = 66.7/(10·50) = 0.133, ε = 10·(1 − 1/√1.0178) = 0.0877
// mm.
TEST(ContourRoom, ActHoldsTheLimitOnTheLargestStepThatTheClosedFormAllows) {
  // v_max for 10 µm is 1343 mm/min = 33 % of F4000: the step is 30 %.
  Circle circle(lagging_mill(Mode::act, true));
  const auto command = circle.run(5.0);
  EXPECT_EQ(command.feed_ratio, 0.30);
  EXPECT_TRUE(command.feed_masks_panel);
  EXPECT_GE(static_cast<int>(command.feed_reason), 300) << name(command.feed_reason);
  EXPECT_LT(static_cast<int>(command.feed_reason), 400) << name(command.feed_reason);
  EXPECT_LE(circle.true_error_mm(), 0.010);
  EXPECT_GE(circle.true_error_mm(), 0.0075) << "40 % would give 0.0142";
}

TEST(ContourRoom, AdviseNamesAStepAndLeavesTheMachineAlone) {
  Circle circle(lagging_mill(Mode::advise, true));
  const auto command = circle.run(5.0);
  EXPECT_FALSE(command.write);
  EXPECT_LT(command.feed_ratio, 1.0);
  EXPECT_NEAR(circle.true_error_mm(), 0.0877, 0.0877 * 0.01);
}

TEST(ContourRoom, SwitchedOffInTheMachineFileItAsksForNothing) {
  Circle circle(lagging_mill(Mode::act, false));
  const auto command = circle.run(2.0);
  EXPECT_FALSE(circle.supervisor.estimates().contour);
  EXPECT_FALSE(command.feed_masks_panel);
  EXPECT_EQ(command.feed_reason, Reason::none);
  EXPECT_NEAR(circle.true_error_mm(), 0.0877, 0.0877 * 0.01);
}

TEST(ContourRoom, ACycleWithTheRoomAllocatesNothing) {
  Circle circle(lagging_mill(Mode::act, true));
  circle.run(0.1);
  const kernel::rt::testing::AllocationGuard guard;
  circle.run(0.5);
}

TEST(ContourRoom, SettingsThatTheRoomRefusesAreTheSupervisorsRefusal) {
  auto machine = lagging_mill(Mode::act, true);
  machine.contour.min_ratio = 0.96;
  machine.contour.max_ratio = 0.97;
  EXPECT_FALSE(Supervisor::make(machine, {.feed_override = true}));
  machine.contour.enabled = false;
  EXPECT_TRUE(Supervisor::make(machine, {.feed_override = true}));
}

}  // namespace
}  // namespace steadyrest::supervisor
