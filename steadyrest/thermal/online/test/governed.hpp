// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cmath>

#include <gtest/gtest.h>

#include <steadyrest/kernel/override/envelope.hpp>
#include <steadyrest/thermal/online/offset_governor.hpp>

/// Base of the offset governor tests: a mill whose Z grows by one thermal mode and whose X follows
/// a room sensor.
namespace steadyrest::thermal::online::test {

inline constexpr double kTau_s = 600.0;
inline constexpr double kLevel_mm = 0.040;  ///< at 100 rev/s
inline constexpr std::size_t kX = 0;
inline constexpr std::size_t kZ = 2;

inline kernel::machine::Machine mill() {
  kernel::machine::Machine machine;
  machine.axes.resize(3);
  machine.axes[1].name = "Y";
  machine.axes[2].name = "Z";
  machine.thermal.enabled = true;
  machine.thermal.max_offset_mm = 0.030;
  machine.thermal.slope_mm_s = 0.010 / 60.0;
  kernel::machine::ThermalAxis z;
  z.name = "Z";
  z.noise_mm = 0.0005;
  z.max_speed_rev_s = 100.0;
  z.mode.emplace_back();
  z.mode[0].tau_s = kTau_s;
  z.mode[0].speed_rev_s = {0.0, 100.0};
  z.mode[0].level_mm = {0.0, kLevel_mm};
  kernel::machine::ThermalAxis x;
  x.name = "X";
  x.ambient.push_back(
      {.sensor = "room", .tau_s = 0.0, .gain_mm_k = 0.002, .reference_c = 20.0, .state_c = 20.0});
  kernel::machine::ThermalAxis probe;
  probe.name = "ch3";
  probe.mode = z.mode;
  machine.thermal.axis = {z, x, probe};
  return machine;
}

/// The governor with its frame, followed by the envelope as in the supervisor: what it lets pass
/// comes down with the next frame. Each cycle takes 0.1 s.
class Governed {
 public:
  static constexpr double kCycle_s = 0.1;

  struct Seen : OffsetGovernor::Output {
    kernel::signal::AxisValues offset_mm{};  ///< passed by the envelope
  };

  explicit Governed(const kernel::machine::Machine& machine = mill())
      : governor(OffsetGovernor::make(machine).value()), envelope(envelope_of(machine)) {
    frame.motion = kernel::signal::Motion::feed;
    frame.spindle_actual_rev_s = 50.0;
    frame.temperature_c[0] = 20.0;
  }

  [[nodiscard]] const kernel::signal::AxisValues& offset_mm() const noexcept {
    return envelope.state().offset_mm;
  }
  /// The governor alone.
  const OffsetGovernor::Output& look() {
    return governor.update(frame, unfit, tool_in_cut,
                           {.offset_mm = offset_mm(), .written = written});
  }
  Seen cycle() { return cycle(kCycle_s); }
  Seen cycle(double step_s) {
    frame.time_s += step_s;
    const OffsetGovernor::Output& out = look();
    const auto let_through = envelope.update(
        {.step_s = step_s, .request = out.request, .unfit = unfit, .tool_in_cut = tool_in_cut});
    return {out, let_through.offset_mm};
  }
  Seen seconds(double s) {
    const auto cycles = static_cast<int>(std::lround(s / kCycle_s));
    for (int i = 1; i < cycles; ++i) {
      cycle();
    }
    return cycle();
  }

  OffsetGovernor governor;
  kernel::override::OffsetEnvelope envelope;
  kernel::signal::Frame frame;
  kernel::outcome::Reason unfit = kernel::outcome::Reason::none;
  bool tool_in_cut = true;
  bool written = true;

 private:
  static kernel::override::OffsetEnvelope envelope_of(const kernel::machine::Machine& machine) {
    kernel::override::OffsetEnvelope::Config config{.slew_mm_s = machine.envelope.offset_slew_mm_s,
                                                    .max_step_s = machine.envelope.stale_after_s};
    config.max_mm.fill(machine.envelope.max_offset_mm);
    return kernel::override::OffsetEnvelope::make(config).value();
  }
};

}  // namespace steadyrest::thermal::online::test
