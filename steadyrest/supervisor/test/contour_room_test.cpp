// SPDX-License-Identifier: Apache-2.0
#include <array>
#include <cmath>
#include <numbers>

#include <gtest/gtest.h>

#include <steadyrest/kernel/override/test/published_tables.hpp>
#include <steadyrest/kernel/rt/testing/allocation_guard.hpp>
#include <steadyrest/supervisor/supervisor.hpp>
#include <steadyrest/supervisor/test/bench.hpp>

namespace steadyrest::supervisor {
namespace {

namespace machine = kernel::machine;
namespace signal = kernel::signal;
using kernel::outcome::Reason;
using machine::Mode;
using test::kCycle_s;

constexpr double kRadius_mm = 10.0;
constexpr double kFeed_mm_s = 4000.0 / 60.0;
constexpr double kGain_1_s = 50.0;
constexpr double kTurns = 20.0;

// Codes of the 840D's feed switch: Gray code of the step's number, i xor i/2.
machine::Machine lagging_mill(Mode mode, bool contour) {
  machine::Machine machine;
  machine.mode = mode;
  machine.axes.resize(3);
  for (auto& axis : machine.axes) {
    axis.servo_gain_1_s = kGain_1_s;
  }
  machine.feed_override = kernel::override::test::feed_840d();
  for (std::uint32_t i = 0; i < machine.feed_override.ratio.size(); ++i) {
    machine.feed_override.code.push_back((i + 1) ^ ((i + 1) >> 1U));
  }
  machine.contour.enabled = contour;
  return machine;
}

/// A circle of many turns, two axes that lag by dx/dt = k·(command − x), and an override that acts
/// one cycle after it was written.
class Circle {
 public:
  explicit Circle(const machine::Machine& machine)
      : supervisor(Supervisor::make(machine, {.feed_override = true}).value()) {
    arc_.geometry = signal::Geometry::arc;
    arc_.start_mm = arc_.end_mm = {kRadius_mm, 0.0, 0.0};
    arc_.axis = {0.0, 0.0, 1.0};
    arc_.radius_mm = arc_.radius_end_mm = kRadius_mm;
    arc_.sweep_rad = kTurns * 2.0 * std::numbers::pi;
    arc_.length_mm = kRadius_mm * arc_.sweep_rad;
    arc_.feed_mm_s = kFeed_mm_s;
    frame_.motion = signal::Motion::feed;
    frame_.programmed_feed_mm_s = kFeed_mm_s;
    frame_.path = {&arc_, 1};
  }

  signal::Command cycle() {
    move();
    const auto command = supervisor.update(frame_);
    const bool in_force = command.write && command.feed_masks_panel;
    frame_.feed.effective_ratio = in_force ? command.feed_ratio : frame_.feed.panel_ratio;
    return command;
  }
  signal::Command run(double time_s) {
    signal::Command command;
    for (double t = 0.0; t < time_s; t += kCycle_s) {
      command = cycle();
    }
    return command;
  }
  /// Closed form on the circle: how far inside of it the actual point is.
  [[nodiscard]] double true_error_mm() const { return kRadius_mm - std::hypot(x_[0], x_[1]); }

  Supervisor supervisor;

 private:
  // Twenty substeps per cycle keep Euler's error far below the 1 % that the tests allow.
  void move() {
    constexpr int kParts = 20;
    const double speed_mm_s = kFeed_mm_s * frame_.feed.effective_ratio;
    for (int part = 0; part < kParts; ++part) {
      s_mm_ += speed_mm_s * kCycle_s / kParts;
      for (std::size_t i = 0; i < 2; ++i) {
        x_[i] += kGain_1_s * (command_mm(i) - x_[i]) * kCycle_s / kParts;
      }
    }
    frame_.time_s += kCycle_s;
    frame_.path_position_mm = s_mm_;
    frame_.path_speed_mm_s = speed_mm_s;
    for (std::size_t i = 0; i < 2; ++i) {
      auto& axis = frame_.axis[i];
      axis.command_mm = command_mm(i);
      axis.actual_mm = x_[i];
      axis.following_error_mm = axis.command_mm - axis.actual_mm;
    }
  }
  [[nodiscard]] double command_mm(std::size_t axis) const {
    const double angle = s_mm_ / kRadius_mm;
    return kRadius_mm * (axis == 0 ? std::cos(angle) : std::sin(angle));
  }

  signal::PathSegment arc_;
  signal::Frame frame_;
  double s_mm_ = 0.0;
  std::array<double, 2> x_{kRadius_mm, 0.0};
};

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
