// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <cmath>
#include <utility>

#include <steadyrest/kernel/outcome/bad_input.hpp>
#include <steadyrest/sim/base/range.hpp>
#include <steadyrest/sim/simulated_machine.hpp>

// The port of a simulated machine. read() advances the machine by one layer cycle and shows the end
// of it; write() sets what applies in the next. A command thus acts one cycle after the frame that
// it was based on, as on a real control.
namespace steadyrest::sim {
namespace {

using kernel::outcome::refuse;
using kernel::outcome::Result;

constexpr double kPlunge = 0.05;  ///< share of the path's speed in the XY plane; a plunge has less

kernel::signal::AxisValues start_of(const nc::plan::PlannedPath& path) noexcept {
  kernel::signal::AxisValues position{};
  if (!path.segments.empty()) {
    const kernel::signal::PathSegment& first = path.segments.front();
    std::ranges::copy(first.start_mm, position.begin());
    std::ranges::copy(first.other_start, position.begin() + 3);
  }
  return position;
}

}  // namespace

Result<std::unique_ptr<SimulatedMachine>> SimulatedMachine::make(const Config& config) {
  if (config.path == nullptr) {
    return std::unexpected(refusal("the simulated machine has no planned path"));
  }
  auto body =
      MachineBody::make({.machine = config.machine, .operator_actions = config.operator_actions});
  if (!body) {
    return std::unexpected(body.error());
  }
  auto interpolator = nc::plan::Interpolator::make(config.machine, nc::plan::whole(*config.path));
  if (!interpolator) {
    return std::unexpected(interpolator.error());
  }
  // Without a cut there is no vibration, and the frame's stays empty.
  std::optional<CuttingVibration> cutting;
  if (config.cutting) {
    auto made = CuttingVibration::make(*config.cutting);
    if (!made) {
      return std::unexpected(made.error());
    }
    cutting = *std::move(made);
  }
  body->reset(start_of(*config.path));
  return std::unique_ptr<SimulatedMachine>(
      new SimulatedMachine(config, *std::move(body), *std::move(interpolator), std::move(cutting)));
}

SimulatedMachine::SimulatedMachine(const Config& config, MachineBody body,
                                   nc::plan::Interpolator interpolator,
                                   std::optional<CuttingVibration> cutting)
    : path_(config.path),
      periods_per_cycle_(std::max(
          1.0, layer_cycle_s(config.machine) / config.machine.control.interpolator_period_s)),
      period_s_(config.machine.control.interpolator_period_s),
      turning_(config.cutting && config.cutting->cut.turning),
      body_(std::move(body)),
      interpolator_(std::move(interpolator)),
      cutting_(std::move(cutting)) {
  // The port's capabilities follow from the machine file alone: a switch described there can be
  // written, an offset limit above 0 means that offsets are taken.
  capability_ = {.feed_override = body_.feed_input().has_value(),
                 .spindle_override = body_.spindle_input().has_value(),
                 .axis_offset = config.machine.envelope.max_offset_mm > 0.0,
                 .path_offset = config.machine.envelope.max_path_offset_mm > 0.0,
                 .latched_word = config.machine.feed_override.latched_word &&
                                 config.machine.spindle_override.latched_word};
}

kernel::port::Capability SimulatedMachine::capability() const noexcept {
  return capability_;
}

/// The cut of one period, at the mean of the spindle's speeds at both ends. A plunging mill cuts
/// with its face, which the process does not model: with less than 5 % of the speed in the XY plane
/// it counts as out of the cut.
void SimulatedMachine::vibrate(const nc::plan::Setpoint& setpoint, double before_rev_s) noexcept {
  const double x = setpoint.velocity[0];
  const double y = setpoint.velocity[1];
  const double across_mm_s = std::sqrt(x * x + y * y);
  const bool feeds = setpoint.motion == kernel::signal::Motion::feed;
  CuttingVibration::Input input{
      .period_s = period_s_,
      .speed_rev_s = 0.5 * (before_rev_s + body_.truth().spindle_rev_s),
      .path_speed_mm_s = turning_ ? setpoint.path_speed_mm_s : across_mm_s,
      .in_cut = feeds && (turning_ || across_mm_s > kPlunge * setpoint.path_speed_mm_s)};
  if (!turning_ && across_mm_s > 0.0) {
    input.feed_direction = {x / across_mm_s, y / across_mm_s};
  }
  cutting_->advance(input);
}

bool SimulatedMachine::step() noexcept {
  constexpr double kRounding = 1e-9;  // of the quotient of two periods
  const auto end_of = [this](std::uint64_t cycle) {
    return static_cast<std::uint64_t>(
        std::ceil(static_cast<double>(cycle) * periods_per_cycle_ * (1.0 - kRounding)));
  };
  if (cutting_ && periods_ == end_of(cycles_)) {
    cutting_->begin_cycle();
  }
  // The interpolator needs this period's overrides, the body the resulting setpoint.
  const double before_rev_s = body_.truth().spindle_rev_s;
  const nc::plan::Setpoint setpoint = interpolator_.update(body_.begin(command_));
  body_.end(setpoint);
  if (cutting_) {
    vibrate(setpoint, before_rev_s);
  }
  const bool ends = ++periods_ == end_of(cycles_ + 1);
  cycles_ += ends ? 1 : 0;
  return ends;
}

kernel::signal::Frame SimulatedMachine::frame() const noexcept {
  kernel::signal::Frame frame = body_.frame();
  if (cutting_) {
    frame.vibration = cutting_->samples();
    frame.vibration_rate_hz = cutting_->sensor_rate_hz();
  }
  frame.path = path_->segments;
  if (path_->original) {
    frame.original = path_->original->segments;
  }
  frame.original_unknown = !path_->original_unknown.empty();
  frame.heat_in_text = path_->heat_in_text;
  return frame;
}

Result<kernel::signal::Frame> SimulatedMachine::read() noexcept {
  while (!step()) {
  }
  return frame();
}

Result<void> SimulatedMachine::write(const kernel::signal::Command& command) noexcept {
  // A supervisor that writes in any mode but act is a fault worth stopping for.
  if (!command.write) {
    return refuse("the port was handed a command in a mode that does not write",
                  "write only in mode act");
  }
  command_ = command;
  return {};
}

}  // namespace steadyrest::sim
