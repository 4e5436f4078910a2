// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <limits>
#include <optional>
#include <vector>

#include <steadyrest/kernel/machine/machine.hpp>
#include <steadyrest/kernel/outcome/result.hpp>
#include <steadyrest/kernel/signal/command.hpp>
#include <steadyrest/kernel/signal/frame.hpp>
#include <steadyrest/nc/plan/time/setpoint.hpp>
#include <steadyrest/sim/axis/axis_offset.hpp>
#include <steadyrest/sim/axis/axis_servo.hpp>
#include <steadyrest/sim/base/noise.hpp>
#include <steadyrest/sim/heat/thermal_growth.hpp>
#include <steadyrest/sim/panel/operator_panel.hpp>
#include <steadyrest/sim/panel/override_input.hpp>
#include <steadyrest/sim/panel/spindle_drive.hpp>

namespace steadyrest::sim {

/// What really happens at the machine; no control can see it.
struct Truth {
  double time_s = 0.0;
  /// Table side with heat and disturbance: the actual place of the cut.
  kernel::signal::AxisValues tool_mm{};
  kernel::signal::AxisValues heat_mm{};        ///< the part of it due to thermal growth
  kernel::signal::AxisValues velocity_mm_s{};  ///< of the table side, without the disturbance
  kernel::signal::AxisValues motor_mm{};       ///< motor side, where the encoder sits
  kernel::signal::AxisValues motor_mm_s{};
  kernel::signal::AxisValues motor_mm_s2{};  ///< see AxisServo::State::acceleration_mm_s2
  kernel::signal::AxisValues command_mm{};   ///< commanded, offsets included
  kernel::signal::AxisValues program_mm{};   ///< commanded by the program, without offsets
  double spindle_rev_s = 0.0;
  bool spindle_at_speed = true;
  std::uint8_t saturated_axes = 0;  ///< bit i: the drive of axis i was at its limit
};

/// Everything of the machine except the interpolator: panel and override inputs, spindle, servos.
///
/// One interpolator period is begin() → setpoint from the interpolator → end(). Time t = n·T.
///   begin  the operator's actions up to t take effect; the PLC scans; the spindle turns on by T
///          towards the last setpoint's command · spindle override (100 % while tapping)
///   end    the setpoint is reached at the end of the period; between setpoints the servo periods
///          get the cubic through both setpoints' positions and velocities (fine interpolation);
///          offsets run linearly between their values at both ends
/// Frame: command and encoder reading at the end of the period, following error their difference;
/// of encoders with counts the count and the time of the last edge with its direction, the instant
/// on the true motion (edge_search.hpp) cut off to the counter's clock. A new edge has a new time.
/// Where a probing move ends the probe has found its goal: along the linear axis that it moved
/// furthest it reads what heat and offset have left, with the probe's noise
/// (`simulation.probe_noise_um`), if that axis has a thermal passport.
/// The disturbance (`simulation.position_noise_mm`, correlation time 2 ms) moves the tool of linear
/// axes unseen by the motors' encoders: only Truth has it.
/// axes beyond the motors' encoders: only Truth has it.
class MachineBody {
 public:
  struct Config {
    kernel::machine::Machine machine;
    // Designated initialisers may leave it out.
    // NOLINTNEXTLINE(readability-redundant-member-init)
    std::vector<OperatorAction> operator_actions = {};
    double noise_correlation_s = 0.002;
  };

  /// Refuses a machine without axes or with more than kMaxAxes, and an interpolator period that is
  /// not a whole multiple of the servo period.
  static kernel::outcome::Result<MachineBody> make(const Config& config);

  /// Standstill at a position, at time 0.
  void reset(const kernel::signal::AxisValues& position_mm) noexcept;

  nc::plan::Overrides begin(const kernel::signal::Command& layer) noexcept;
  void end(const nc::plan::Setpoint& setpoint) noexcept;

  [[nodiscard]] const Truth& truth() const noexcept { return truth_; }
  /// Everything but the path.
  [[nodiscard]] kernel::signal::Frame frame() const noexcept;
  [[nodiscard]] const std::optional<OverrideInput>& feed_input() const noexcept { return feed_; }
  [[nodiscard]] const std::optional<OverrideInput>& spindle_input() const noexcept {
    return spindle_override_;
  }

 private:
  /// What a latching counter shows of one encoder.
  struct Counter {
    bool shown = false;
    double clock_s = 0.0;
    double edge_s = std::numeric_limits<double>::quiet_NaN();
    std::int8_t direction = 0;
  };

  MachineBody(const Config& config, std::vector<AxisServo> servos, SpindleDrive spindle,
              std::optional<ThermalGrowth> growth, std::optional<OverrideInput> feed,
              std::optional<OverrideInput> rapid, std::optional<OverrideInput> spindle_override);
  void watch(std::uint64_t heartbeat) noexcept;
  void grow(const nc::plan::Setpoint& setpoint) noexcept;
  void read_sensors() noexcept;
  void probe(const nc::plan::Setpoint& setpoint) noexcept;
  void latch(std::size_t axis, std::uint32_t periods_left) noexcept;
  void follow(std::size_t axis, const nc::plan::Setpoint& setpoint, double offset_mm) noexcept;

  double period_s_;
  std::uint32_t servo_periods_;
  double watchdog_s_;
  double servo_period_s_;
  std::vector<AxisServo> servos_;
  std::vector<Counter> counters_;
  std::vector<bool> disturbed_;
  std::vector<bool> rotary_;
  SpindleDrive spindle_;
  std::optional<OverrideInput> feed_;
  std::optional<OverrideInput> rapid_;
  std::optional<OverrideInput> spindle_override_;
  OperatorPanel panel_;
  AxisOffset offset_;
  AxisOffset path_offset_;
  std::optional<ThermalGrowth> growth_;
  std::vector<std::size_t> grown_axis_;  ///< of each displacement; kMaxAxes: no such axis
  ThermalGrowth::Input heating_;         ///< sums since the last step
  std::uint32_t heating_periods_ = 0;
  std::uint32_t periods_of_growth_ = 1;  ///< between two steps
  kernel::signal::ProbeReading reading_;
  kernel::signal::AxisValues probe_from_mm_{};
  double probe_noise_mm_ = 0.0;
  std::size_t sensors_ = 0;  ///< of temperature, all of them in the room
  kernel::signal::Temperatures temperature_c_ = kernel::signal::unknown_temperatures();
  NormalNoise normal_;
  std::vector<ColouredNoise> noise_;

  std::uint64_t cycle_ = 0;
  double time_s_ = 0.0;
  std::uint64_t heartbeat_ = 0;
  double heartbeat_time_s_ = 0.0;
  bool alive_ = false;
  kernel::signal::AxisValues layer_offset_mm_{};
  kernel::signal::AxisValues layer_path_offset_mm_{};
  kernel::signal::OverrideState feed_state_;
  kernel::signal::OverrideState rapid_state_;
  kernel::signal::OverrideState spindle_state_;
  SpindleDrive::Output spindle_now_;
  nc::plan::Setpoint setpoint_;
  kernel::signal::AxisValues offset_mm_{};
  Truth truth_;
};

}  // namespace steadyrest::sim
