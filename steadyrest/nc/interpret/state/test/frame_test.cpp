// SPDX-License-Identifier: Apache-2.0
#include <cmath>

#include <gtest/gtest.h>
#include <rapidcheck.h>

#include <steadyrest/nc/interpret/state/frame.hpp>

namespace steadyrest::nc::interpret {
namespace {

Axes any_axes() {
  Axes axes{};
  for (double& axis : axes) {
    axis = *rc::gen::inRange(-100000, 100001) / 100.0;
  }
  return axes;
}
double difference(const Axes& left, const Axes& right) {
  double largest = 0.0;
  for (std::size_t i = 0; i < left.size(); ++i) {
    largest = std::fmax(largest, std::abs(left[i] - right[i]));
  }
  return largest;
}

// Counter-clockwise, as G10 L2 R and ROT: X goes to Y.
TEST(Frame, AQuarterTurnTakesXToY) {
  const Axes axes = {3.0, 4.0, 5.0, 6.0, 7.0, 8.0, 9.0, 10.0, 11.0};
  EXPECT_LT(difference(turned(axes, 90.0), {-4.0, 3.0, 5.0, 6.0, 7.0, 8.0, 9.0, 10.0, 11.0}),
            1e-14);
  EXPECT_LT(difference(turned(axes, 180.0), {-3.0, -4.0, 5.0, 6.0, 7.0, 8.0, 9.0, 10.0, 11.0}),
            1e-14);
  EXPECT_EQ(turned(axes, 0.0), axes);
}

TEST(Frame, TurnsAddUpAndKeepTheDistance) {
  EXPECT_TRUE(rc::check([] {
    const Axes axes = any_axes();
    const double first_deg = *rc::gen::inRange(-36000, 36001) / 100.0;
    const double second_deg = *rc::gen::inRange(-36000, 36001) / 100.0;
    const Axes twice = turned(turned(axes, first_deg), second_deg);
    RC_ASSERT(difference(twice, turned(axes, first_deg + second_deg)) < 1e-9);
    RC_ASSERT(std::abs(std::hypot(twice[0], twice[1]) - std::hypot(axes[0], axes[1])) < 1e-9);
  }));
}

// LinuxCNC, "Coordinate Systems": the rotation is about the offset's zero, then the offset is
// added.
TEST(Frame, TheMachineIsTurnedAboutTheWorksZeroAndThenShifted) {
  Move move;
  move.rotation_deg = 90.0;
  move.offset = {100.0, 200.0, 300.0, 1.0};
  EXPECT_LT(difference(machine_of(move, {10.0, 20.0, 30.0, 40.0}), {80.0, 210.0, 330.0, 41.0}),
            1e-12);
  EXPECT_LT(difference(machine_of(move, {}), move.offset), 1e-12);
}

TEST(Frame, DistancesInTheWorkAreThoseInTheMachine) {
  EXPECT_TRUE(rc::check([] {
    Move move;
    move.rotation_deg = *rc::gen::inRange(-18000, 18001) / 100.0;
    move.offset = any_axes();
    const Axes from = any_axes();
    const Axes to = any_axes();
    const Axes machine_from = machine_of(move, from);
    const Axes machine_to = machine_of(move, to);
    const auto distance_in_xy = [](const Axes& a, const Axes& b) {
      return std::hypot(a[0] - b[0], a[1] - b[1]);
    };
    RC_ASSERT(std::abs(distance_in_xy(from, to) - distance_in_xy(machine_from, machine_to)) < 1e-9);
    RC_ASSERT(std::abs((machine_to[2] - machine_from[2]) - (to[2] - from[2])) < 1e-9);
  }));
}

}  // namespace
}  // namespace steadyrest::nc::interpret
