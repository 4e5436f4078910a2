// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <cmath>
#include <utility>

#include <fmt/format.h>

#include <steadyrest/sim/base/range.hpp>
#include <steadyrest/sim/machine_body.hpp>

// begin() and end() enclose the interpolator: it needs overrides and spindle before it decides on a
// setpoint; heat, offsets and servos follow once it has.
namespace steadyrest::sim {
namespace {

using kernel::machine::Machine;
using kernel::machine::OverrideTable;
using kernel::outcome::Result;
using kernel::signal::Motion;

Result<void> check(const Machine& machine) {
  if (machine.axes.empty() || machine.axes.size() > kernel::signal::kMaxAxes) {
    return std::unexpected(refusal(fmt::format("machine has {} axes; allowed: 1 to {}",
                                               machine.axes.size(), kernel::signal::kMaxAxes)));
  }
  const kernel::machine::Control& c = machine.control;
  if (auto ok = in_range("control", {{"interpolator_period_s", c.interpolator_period_s, 1e-5, 0.1},
                                     {"servo_period_s", c.servo_period_s, 1e-5, 0.1}});
      !ok) {
    return ok;
  }
  const double ratio = c.interpolator_period_s / c.servo_period_s;
  if (std::round(ratio) < 1.0 || std::abs(ratio - std::round(ratio)) > 1e-6) {
    return std::unexpected(refusal(
        fmt::format("interpolator period {} s is not a whole multiple of the servo period {} s",
                    c.interpolator_period_s, c.servo_period_s)));
  }
  return in_range("simulation",
                  {{"position_noise_mm", machine.simulation.position_noise_mm, 0.0, 10.0},
                   {"stale_after_s", machine.envelope.stale_after_s, 1e-3, 1e6},
                   {"max_offset_mm", machine.envelope.max_offset_mm, 0.0, 1e6},
                   {"offset_slew_mm_s", machine.envelope.offset_slew_mm_s, 0.0, 1e6},
                   {"max_path_offset_mm", machine.envelope.max_path_offset_mm, 0.0, 1e6},
                   {"path_offset_slew_mm_s", machine.envelope.path_offset_slew_mm_s, 0.0, 1e6}});
}

/// A machine without a switch is allowed: its override is 100 %.
Result<std::optional<OverrideInput>> input_of(const OverrideTable& table, const Machine& machine) {
  if (table.ratio.empty() && table.code.empty()) {
    return std::nullopt;
  }
  auto made = OverrideInput::make({.table = table,
                                   .period_s = machine.control.interpolator_period_s,
                                   .watchdog_s = kernel::machine::holds_s(machine),
                                   .hand_back_rise_1_s = machine.envelope.feed_rise_1_s});
  if (!made) {
    return std::unexpected(made.error());
  }
  return std::optional<OverrideInput>(*std::move(made));
}

/// Over so long the path offset ramps out from its limit once the layer is lost.
constexpr double kFade_s = 0.2;
constexpr double kGrowth_s = 0.1;  ///< the fastest time constants are minutes

std::uint32_t periods_of_growth(const Machine& machine) noexcept {
  return static_cast<std::uint32_t>(
      std::max(1.0, std::round(kGrowth_s / machine.control.interpolator_period_s)));
}

/// A machine without a thermal passport does not grow.
Result<std::optional<ThermalGrowth>> growth_of(const Machine& machine) {
  if (machine.thermal.axis.empty()) {
    return std::nullopt;
  }
  auto made = ThermalGrowth::make(
      {.passport = machine.thermal,
       .simulation = machine.simulation,
       .period_s = periods_of_growth(machine) * machine.control.interpolator_period_s});
  if (!made) {
    return std::unexpected(made.error());
  }
  return std::optional<ThermalGrowth>(*std::move(made));
}

std::uint32_t home(const std::optional<OverrideInput>& input) noexcept {
  return input ? input->home_code() : 0;
}

}  // namespace

Result<MachineBody> MachineBody::make(const Config& config) {
  const Machine& machine = config.machine;
  if (auto ok = check(machine); !ok) {
    return std::unexpected(ok.error());
  }
  std::vector<AxisServo> servos;
  for (const kernel::machine::Axis& axis : machine.axes) {
    auto servo = AxisServo::make({.axis = axis, .period_s = machine.control.servo_period_s});
    if (!servo) {
      return std::unexpected(servo.error());
    }
    servos.push_back(*servo);
  }
  auto spindle = SpindleDrive::make({.spindle = machine.spindle});
  if (!spindle) {
    return std::unexpected(spindle.error());
  }
  auto feed = input_of(machine.feed_override, machine);
  auto rapid = input_of(machine.rapid_override, machine);
  auto spindle_override = input_of(machine.spindle_override, machine);
  for (const auto* input : {&feed, &rapid, &spindle_override}) {
    if (!*input) {
      return std::unexpected(input->error());
    }
  }
  auto growth = growth_of(machine);
  if (!growth) {
    return std::unexpected(growth.error());
  }
  return MachineBody(config, std::move(servos), *spindle, *std::move(growth), *std::move(feed),
                     *std::move(rapid), *std::move(spindle_override));
}

MachineBody::MachineBody(const Config& config, std::vector<AxisServo> servos, SpindleDrive spindle,
                         std::optional<ThermalGrowth> growth, std::optional<OverrideInput> feed,
                         std::optional<OverrideInput> rapid,
                         std::optional<OverrideInput> spindle_override)
    : period_s_(config.machine.control.interpolator_period_s),
      servo_periods_(static_cast<std::uint32_t>(std::round(
          config.machine.control.interpolator_period_s / config.machine.control.servo_period_s))),
      watchdog_s_(kernel::machine::holds_s(config.machine)),
      servo_period_s_(config.machine.control.servo_period_s),
      servos_(std::move(servos)),
      spindle_(spindle),
      feed_(std::move(feed)),
      rapid_(std::move(rapid)),
      spindle_override_(std::move(spindle_override)),
      panel_({.feed_code = home(feed_),
              .rapid_code = home(rapid_),
              .spindle_code = home(spindle_override_)},
             config.operator_actions),
      offset_(config.machine.envelope.max_offset_mm,
              config.machine.envelope.offset_slew_mm_s * period_s_),
      path_offset_(config.machine.envelope.max_path_offset_mm,
                   config.machine.envelope.path_offset_slew_mm_s * period_s_,
                   config.machine.envelope.max_path_offset_mm / kFade_s * period_s_),
      growth_(std::move(growth)),
      periods_of_growth_(periods_of_growth(config.machine)),
      probe_noise_mm_(config.machine.simulation.probe_noise_mm),
      normal_(config.machine.simulation.seed) {
  // A displacement whose axis the machine lacks (a tilt, say) is computed but moves nothing.
  for (const kernel::machine::ThermalAxis& displacement : config.machine.thermal.axis) {
    const auto found =
        std::ranges::find(config.machine.axes, displacement.name, &kernel::machine::Axis::name);
    grown_axis_.push_back(found != config.machine.axes.end() && found->present
                              ? static_cast<std::size_t>(found - config.machine.axes.begin())
                              : kernel::signal::kMaxAxes);
  }
  if (growth_) {
    sensors_ = std::min(config.machine.thermal.sensors().size(), kernel::signal::kMaxTemperatures);
    read_sensors();
  }
  const double rms_mm = config.machine.simulation.position_noise_mm;
  for (const kernel::machine::Axis& axis : config.machine.axes) {
    counters_.push_back(
        {.shown = axis.present && axis.encoder.count_au > 0.0, .clock_s = axis.encoder.clock_s});
    rotary_.push_back(axis.rotary);
    disturbed_.push_back(rms_mm > 0.0 && axis.present && !axis.rotary);
    noise_.emplace_back(rms_mm, period_s_, config.noise_correlation_s);
  }
}

void MachineBody::reset(const kernel::signal::AxisValues& position_mm) noexcept {
  setpoint_ = {};
  setpoint_.position = position_mm;
  truth_ = {};
  for (std::size_t i = 0; i < servos_.size(); ++i) {
    servos_[i].reset(position_mm[i]);
    counters_[i].edge_s = std::numeric_limits<double>::quiet_NaN();
    counters_[i].direction = 0;
    truth_.tool_mm[i] = truth_.motor_mm[i] = position_mm[i];
    truth_.command_mm[i] = truth_.program_mm[i] = position_mm[i];
  }
}

void MachineBody::watch(std::uint64_t heartbeat) noexcept {
  if (heartbeat != heartbeat_) {
    heartbeat_ = heartbeat;
    heartbeat_time_s_ = time_s_;
  }
  // 0: no layer has ever written.
  alive_ = heartbeat_ != 0 && time_s_ - heartbeat_time_s_ <= watchdog_s_;
}

nc::plan::Overrides MachineBody::begin(const kernel::signal::Command& layer) noexcept {
  ++cycle_;
  // n·T, not a sum: the frame's stamps then do not drift against the interpolator.
  time_s_ = static_cast<double>(cycle_) * period_s_;
  watch(layer.heartbeat);
  layer_offset_mm_ = layer.offset_mm;
  layer_path_offset_mm_ = layer.path_offset_mm;
  const OperatorPanel::State& panel = panel_.update(time_s_);
  if (feed_) {
    feed_state_ = feed_->update({.time_s = time_s_,
                                 .panel_code = panel.feed_code,
                                 .layer_code = layer.feed_code,
                                 .layer_masks = layer.feed_masks_panel,
                                 .heartbeat = layer.heartbeat});
  }
  if (rapid_) {
    rapid_state_ = rapid_->update({.time_s = time_s_, .panel_code = panel.rapid_code});
  }
  if (spindle_override_) {
    spindle_state_ = spindle_override_->update({.time_s = time_s_,
                                                .panel_code = panel.spindle_code,
                                                .layer_code = layer.spindle_code,
                                                .layer_masks = layer.spindle_masks_panel,
                                                .heartbeat = layer.heartbeat});
  }
  // During tapping the control ignores the spindle override.
  const bool tapping = setpoint_.motion == Motion::tap;
  spindle_now_ = spindle_.update({.command_rev_s = setpoint_.spindle_rev_s,
                                  .override_ratio = tapping ? 1.0 : spindle_state_.effective_ratio,
                                  .period_s = period_s_});
  return {.feed_ratio = panel.feed_hold ? 0.0 : feed_state_.effective_ratio,
          .rapid_ratio = panel.feed_hold ? 0.0 : rapid_state_.effective_ratio,
          .spindle_actual_rev_s = spindle_now_.actual_rev_s,
          .spindle_ratio = tapping ? 1.0 : spindle_state_.effective_ratio};
}

/// The counter's latch after a servo period: it holds the last edge until the next one arrives.
void MachineBody::latch(std::size_t axis, std::uint32_t periods_left) noexcept {
  const std::optional<Passage>& edge = servos_[axis].state().edge;
  Counter& counter = counters_[axis];
  if (!edge || counter.clock_s <= 0.0) {
    return;
  }
  const double t_s = time_s_ - periods_left * servo_period_s_ - edge->before_end_s;
  // The counter's clock stamps an edge with the current tick.
  counter.edge_s = std::floor(t_s / counter.clock_s) * counter.clock_s;
  counter.direction = edge->direction;
}

/// Takes one axis through the servo periods of one interpolator period.
void MachineBody::follow(std::size_t axis, const nc::plan::Setpoint& setpoint,
                         double offset_mm) noexcept {
  AxisServo& servo = servos_[axis];
  const double p0 = setpoint_.position[axis];
  const double p1 = setpoint.position[axis];
  const double v0 = setpoint_.velocity[axis];
  const double v1 = setpoint.velocity[axis];
  const double chord = p1 - p0;
  const double moved_mm = offset_mm - offset_mm_[axis];
  const double moved_mm_s = moved_mm / period_s_;
  for (std::uint32_t i = 1; i < servo_periods_; ++i) {
    const double u = static_cast<double>(i) / servo_periods_;
    const double w = 1.0 - u;
    // Cubic Hermite form: chord, and what both end slopes deviate from it.
    const double d0 = v0 * period_s_ - chord;
    const double d1 = v1 * period_s_ - chord;
    const double position = p0 + chord * u + u * w * (w * d0 - u * d1);
    const double speed = (chord + (w - u) * (w * d0 - u * d1) - u * w * (d0 + d1)) / period_s_;
    servo.update(position + offset_mm_[axis] + moved_mm * u, speed + moved_mm_s);
    latch(axis, servo_periods_ - i);
  }
  servo.update(p1 + offset_mm, v1 + moved_mm_s);
  latch(axis, 0);
}

void MachineBody::end(const nc::plan::Setpoint& setpoint) noexcept {
  const bool cuts = kernel::signal::in_cut(setpoint.motion);
  kernel::signal::AxisValues offset_mm = offset_.update(layer_offset_mm_, alive_, cuts);
  const auto& path_offset_mm = path_offset_.update(layer_path_offset_mm_, alive_, cuts);
  for (std::size_t i = 0; i < offset_mm.size(); ++i) {
    offset_mm[i] += path_offset_mm[i];
  }
  truth_.time_s = time_s_;
  truth_.saturated_axes = 0;
  if (growth_) {
    probe(setpoint);
    grow(setpoint);
  }
  for (std::size_t i = 0; i < servos_.size(); ++i) {
    follow(i, setpoint, offset_mm[i]);
    const AxisServo::State& s = servos_[i].state();
    // The motors' encoders miss heat and disturbance: only the truth has them.
    truth_.tool_mm[i] = s.table_mm + truth_.heat_mm[i];
    if (disturbed_[i]) {
      truth_.tool_mm[i] += noise_[i].update(normal_.next());
    }
    truth_.velocity_mm_s[i] = s.table_velocity_mm_s;
    truth_.motor_mm[i] = s.motor_mm;
    truth_.motor_mm_s[i] = s.velocity_mm_s;
    truth_.motor_mm_s2[i] = s.acceleration_mm_s2;
    truth_.command_mm[i] = s.command_mm;
    truth_.program_mm[i] = setpoint.position[i];
    truth_.saturated_axes =
        static_cast<std::uint8_t>(truth_.saturated_axes | (s.saturated ? 1U << i : 0U));
  }
  truth_.spindle_rev_s = spindle_now_.actual_rev_s;
  truth_.spindle_at_speed = spindle_now_.at_speed;
  setpoint_ = setpoint;
  offset_mm_ = offset_mm;
}

kernel::signal::Frame MachineBody::frame() const noexcept {
  kernel::signal::Frame frame;
  frame.time_s = time_s_;
  frame.cycle = cycle_;
  frame.axis_count = static_cast<std::uint8_t>(servos_.size());
  for (std::size_t i = 0; i < servos_.size(); ++i) {
    const AxisServo::State& s = servos_[i].state();
    frame.axis[i] = {.command_mm = s.command_mm,
                     .actual_mm = s.encoder_mm,
                     .following_error_mm = s.command_mm - s.encoder_mm,
                     .offset_mm = offset_mm_[i],
                     .encoder_shown = counters_[i].shown,
                     .count = s.count,
                     .edge_s = counters_[i].edge_s,
                     .edge_direction = counters_[i].direction};
  }
  frame.feed = feed_state_;
  frame.rapid = rapid_state_;
  frame.spindle = spindle_state_;
  frame.motion = setpoint_.motion;
  frame.program_line = setpoint_.line;
  frame.programmed_feed_mm_s = setpoint_.programmed_feed_mm_s;
  frame.feed_per_revolution = setpoint_.feed_per_revolution;
  frame.speed_modulation = setpoint_.speed_modulation;
  frame.path_speed_mm_s = setpoint_.path_speed_mm_s;
  frame.spindle_programmed_rev_s = setpoint_.spindle_rev_s;
  frame.spindle_command_rev_s = spindle_now_.target_rev_s;
  frame.spindle_actual_rev_s = spindle_now_.actual_rev_s;
  frame.coolant = setpoint_.coolant;
  frame.temperature_c = temperature_c_;
  frame.probe = reading_;
  frame.path_index = setpoint_.path_index;
  frame.path_position_mm = setpoint_.path_position_mm;
  return frame;
}

}  // namespace steadyrest::sim
