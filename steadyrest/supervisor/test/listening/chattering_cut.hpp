// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cmath>
#include <numbers>
#include <vector>

#include <steadyrest/kernel/override/test/published_tables.hpp>
#include <steadyrest/supervisor/supervisor.hpp>

namespace steadyrest::supervisor::test {

/// A cut that chatters at 943 Hz from 0.6 s on while the spindle runs at 100 %. The listener's
/// table has 90 % as the better step, and there the cut is quiet.
class ChatteringCut {
 public:
  static constexpr double kCycle_s = 0.002;
  static constexpr double kRate_hz = 10e3;
  static constexpr double kSpeed_rev_s = 80.0;
  static constexpr kernel::port::Capability kPort{
      .feed_override = true, .spindle_override = true, .latched_word = true};

  [[nodiscard]] static kernel::machine::Machine machine() {
    kernel::machine::Machine machine;
    machine.control.interpolator_period_s = kCycle_s;
    machine.axes.resize(3);
    machine.feed_override = kernel::override::test::feed_840d();
    machine.spindle_override = kernel::override::test::spindle_840d();
    machine.contour.enabled = false;
    machine.chatter.enabled = true;
    machine.chatter.law = kernel::machine::SpeedLaw::constant;
    machine.chatter.amplitude_ratio = 0.0;
    machine.chatter.m_code_on = machine.chatter.m_code_off = 0;
    return machine;
  }

  [[nodiscard]] static ListeningStage listener(bool acts = true) {
    ListeningStage::Config config{.better = {}, .depth_mm = 1.0, .acts = acts};
    config.better.detector.sample_rate_hz = kRate_hz;
    config.better.modes_hz = {410.0, 922.0};
    config.better.table.step_ratio = {0.8, 0.9, 1.0};
    config.better.table.max_ratio = 1.0;
    config.better.table.speed_rev_s = {60.0, 70.0, 72.0, 74.0, 100.0};
    config.better.table.limit_depth_mm = {0.1, 0.1, 2.0, 0.1, 0.1};
    return ListeningStage::make(config).value();
  }

  ChatteringCut() {
    frame_.motion = kernel::signal::Motion::feed;
    frame_.spindle.panel_code = 0b01110;
    frame_.feed.panel_code = 0b11010;
    frame_.programmed_feed_mm_s = frame_.path_speed_mm_s = 10.0;
  }

  /// The next cycle's frame; its vibration lives until the next.
  const kernel::signal::Frame& next() {
    samples_.clear();
    const double ratio = frame_.spindle.effective_ratio;
    const bool loud = frame_.time_s > 0.6 && ratio > 0.95;
    const auto count = static_cast<int>(std::lround(kCycle_s * kRate_hz));
    for (int i = 0; i < count; ++i) {
      angle_rev_ += ratio * kSpeed_rev_s / kRate_hz;
      time_s_ += 1.0 / kRate_hz;
      samples_.push_back(std::sin(2.0 * std::numbers::pi * 2.0 * angle_rev_) +
                         (loud ? 3.0 : 0.0) * std::sin(2.0 * std::numbers::pi * 943.0 * time_s_));
    }
    frame_.time_s += kCycle_s;
    frame_.spindle_programmed_rev_s = kSpeed_rev_s;
    frame_.spindle_actual_rev_s = ratio * kSpeed_rev_s;
    frame_.vibration = samples_;
    frame_.vibration_rate_hz = kRate_hz;
    return frame_;
  }

  /// The control acts on it at once.
  void obey(const kernel::signal::Command& command) {
    frame_.spindle.effective_ratio = command.write ? command.spindle_ratio : 1.0;
  }
  void move(kernel::signal::Motion motion) { frame_.motion = motion; }

 private:
  kernel::signal::Frame frame_;
  std::vector<double> samples_;
  double angle_rev_ = 0.0;
  double time_s_ = 0.0;
};

}  // namespace steadyrest::supervisor::test
