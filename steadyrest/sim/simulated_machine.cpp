// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <cmath>
#include <utility>

#include <steadyrest/sim/range.hpp>
#include <steadyrest/sim/simulated_machine.hpp>

namespace steadyrest::sim {
namespace {

using kernel::outcome::Kind;
using kernel::outcome::Refusal;
using kernel::outcome::Result;

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
  if (config.periods_per_cycle == 0) {
    return std::unexpected(refusal("periods_per_cycle is 0; allowed is 1 or more"));
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
  body->reset(start_of(*config.path));
  return std::unique_ptr<SimulatedMachine>(
      new SimulatedMachine(config, *std::move(body), *std::move(interpolator)));
}

SimulatedMachine::SimulatedMachine(const Config& config, MachineBody body,
                                   nc::plan::Interpolator interpolator)
    : path_(config.path),
      periods_per_cycle_(config.periods_per_cycle),
      body_(std::move(body)),
      interpolator_(std::move(interpolator)) {
  capability_ = {.feed_override = body_.feed_input().has_value(),
                 .spindle_override = body_.spindle_input().has_value(),
                 .axis_offset = config.machine.envelope.max_offset_mm > 0.0,
                 .latched_word = config.machine.feed_override.latched_word &&
                                 config.machine.spindle_override.latched_word};
}

kernel::port::Capability SimulatedMachine::capability() const noexcept {
  return capability_;
}

Result<kernel::signal::Frame> SimulatedMachine::read() noexcept {
  for (std::uint32_t i = 0; i < periods_per_cycle_; ++i) {
    body_.end(interpolator_.update(body_.begin(command_)));
  }
  kernel::signal::Frame frame = body_.frame();
  frame.path = path_->segments;
  return frame;
}

Result<void> SimulatedMachine::write(const kernel::signal::Command& command) noexcept {
  if (!command.write) {
    return std::unexpected(Refusal{Kind::bad_input,
                                   {},
                                   0,
                                   "a command that is not to be written was handed to the port",
                                   "write only in mode act"});
  }
  command_ = command;
  return {};
}

}  // namespace steadyrest::sim
