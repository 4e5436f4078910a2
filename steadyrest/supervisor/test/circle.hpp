// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cmath>
#include <numbers>

#include <steadyrest/kernel/override/test/published_tables.hpp>
#include <steadyrest/supervisor/supervisor.hpp>
#include <steadyrest/supervisor/test/bench.hpp>

/// A circle cut by lagging axes, for the tests of the contour room in the supervisor.
namespace steadyrest::supervisor::test {

inline constexpr double kRadius_mm = 10.0;
inline constexpr double kFeed_mm_s = 4000.0 / 60.0;
inline constexpr double kGain_1_s = 50.0;
inline constexpr double kTurns = 20.0;

// Codes of the 840D's feed switch: Gray code of the step's number, i xor i/2.
inline machine::Machine lagging_mill(Mode mode, bool contour) {
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
  explicit Circle(const machine::Machine& machine,
                  const kernel::port::Capability& capability = {.feed_override = true})
      : supervisor(Supervisor::make(machine, capability).value()) {
    arc_.geometry = signal::Geometry::arc;
    arc_.start_mm = arc_.end_mm = {kRadius_mm, 0.0, 0.0};
    arc_.axis = {0.0, 0.0, 1.0};
    arc_.radius_mm = arc_.radius_end_mm = kRadius_mm;
    arc_.sweep_rad = kTurns * 2.0 * std::numbers::pi;
    arc_.length_mm = kRadius_mm * arc_.sweep_rad;
    arc_.feed_mm_s = kFeed_mm_s;
    frame.motion = signal::Motion::feed;
    frame.programmed_feed_mm_s = kFeed_mm_s;
    frame.path = {&arc_, 1};
  }

  signal::Command cycle() {
    move();
    const auto command = supervisor.update(frame);
    const bool in_force = command.write && command.feed_masks_panel;
    frame.feed.effective_ratio = in_force ? command.feed_ratio : frame.feed.panel_ratio;
    before_mm_ = offset_mm_;
    offset_mm_ = command.write ? command.path_offset_mm : signal::AxisValues{};
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
  signal::Frame frame;

 private:
  // Twenty substeps per cycle keep Euler's error far below the 1 % that the tests allow.
  void move() {
    constexpr int kParts = 20;
    const double speed_mm_s = kFeed_mm_s * frame.feed.effective_ratio;
    for (int part = 0; part < kParts; ++part) {
      s_mm_ += speed_mm_s * kCycle_s / kParts;
      for (std::size_t i = 0; i < 2; ++i) {
        const double offset_mm =
            before_mm_[i] + (offset_mm_[i] - before_mm_[i]) * (part + 1.0) / kParts;
        x_[i] += kGain_1_s * (command_mm(i) + offset_mm - x_[i]) * kCycle_s / kParts;
      }
    }
    frame.time_s += kCycle_s;
    frame.path_position_mm = s_mm_;
    frame.path_speed_mm_s = speed_mm_s;
    for (std::size_t i = 0; i < 2; ++i) {
      auto& axis = frame.axis[i];
      axis.command_mm = command_mm(i) + offset_mm_[i];
      axis.actual_mm = x_[i];
      axis.following_error_mm = axis.command_mm - axis.actual_mm;
    }
  }
  [[nodiscard]] double command_mm(std::size_t axis) const {
    const double angle = s_mm_ / kRadius_mm;
    return kRadius_mm * (axis == 0 ? std::cos(angle) : std::sin(angle));
  }

  signal::PathSegment arc_;
  double s_mm_ = 0.0;
  std::array<double, 2> x_{kRadius_mm, 0.0};
  signal::AxisValues before_mm_{}, offset_mm_{};  ///< path offset of the last two cycles
};

}  // namespace steadyrest::supervisor::test
