// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cmath>
#include <cstdint>
#include <numbers>

#include <steadyrest/kernel/units/constants.hpp>
#include <steadyrest/supervisor/test/bench.hpp>

/// The encoder that the tests of the motion stage read, and how its axis swings.
namespace steadyrest::supervisor::test {

inline constexpr double kCount_mm = 0.001;
inline constexpr double kClock_s = 1e-7;
inline constexpr double kRate_1_s = kernel::units::kTurn * 2.0;  ///< 2 Hz

inline constexpr double kAmplitude_mm = 1.0;

/// Two axes; the limits are those of the sine below.
inline machine::Machine two_axes() {
  machine::Machine machine;
  machine.axes.resize(2);
  for (auto& axis : machine.axes) {
    axis.encoder.count_au = kCount_mm;
    axis.max_speed_au_s = kAmplitude_mm * kRate_1_s;
    axis.max_acceleration_au_s2 = axis.max_speed_au_s * kRate_1_s;
    axis.max_jerk_au_s3 = axis.max_acceleration_au_s2 * kRate_1_s;
  }
  return machine;
}

/// x = A·(1 − cos ωt), 2 Hz, and what a latching counter shows of it in closed form.
class Sine {
 public:
  signal::Frame next() {
    signal::Frame frame;
    frame.axis_count = 2;
    frame.cycle = ++cycle_;
    frame.time_s = static_cast<double>(cycle_) * kCycle_s;
    const double phase = std::fmod(kRate_1_s * frame.time_s, 2.0 * std::numbers::pi);
    const bool rises = phase < std::numbers::pi;
    const double x = kAmplitude_mm * (1.0 - std::cos(phase));
    const auto count = static_cast<std::int64_t>(std::floor(x / kCount_mm + 0.5));
    // On the way up the line below was passed last. Just after the top no line has been passed on
    // the way down, so the last one is still the one below, on the way up.
    const double top = std::floor(2.0 * kAmplitude_mm / kCount_mm + 0.5);
    const bool up = rises ? count > 0 : static_cast<double>(count) == top;
    const double line = static_cast<double>(count) + (up ? -0.5 : 0.5);
    const double at = std::acos(1.0 - line * kCount_mm / kAmplitude_mm);
    const double line_phase = up ? at : 2.0 * std::numbers::pi - at;
    double edge_s = frame.time_s - (phase - line_phase) / kRate_1_s;
    edge_s -= edge_s > frame.time_s ? 2.0 * std::numbers::pi / kRate_1_s : 0.0;
    velocity_mm_s = kAmplitude_mm * kRate_1_s * std::sin(phase);
    acceleration_mm_s2 = kAmplitude_mm * kRate_1_s * kRate_1_s * std::cos(phase);
    auto& axis = frame.axis[0];
    axis.actual_mm = axis.command_mm = static_cast<double>(count) * kCount_mm;
    axis.encoder_shown = true;
    axis.count = count;
    axis.edge_s = edge_s > 0.0 ? std::floor(edge_s / kClock_s) * kClock_s : kernel::units::kNan;
    axis.edge_direction = up ? std::int8_t{1} : std::int8_t{-1};
    return frame;
  }

  double velocity_mm_s = 0.0;
  double acceleration_mm_s2 = 0.0;

 private:
  std::uint64_t cycle_ = 0;
};

}  // namespace steadyrest::supervisor::test
