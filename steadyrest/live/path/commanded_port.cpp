// SPDX-License-Identifier: Apache-2.0
#include <cmath>
#include <utility>

#include <steadyrest/live/path/commanded_port.hpp>

namespace steadyrest::live {

using kernel::outcome::Result;
using kernel::signal::Frame;
using supervisor::MotionStage;

Result<std::unique_ptr<CommandedPort>> CommandedPort::make(
    kernel::port::Port& port, const kernel::machine::Machine& machine) {
  auto motion = MotionStage::make(machine);
  if (!motion) {
    return std::unexpected(std::move(motion.error()));
  }
  return std::unique_ptr<CommandedPort>(new CommandedPort(port, machine, std::move(*motion)));
}

CommandedPort::CommandedPort(kernel::port::Port& port, const kernel::machine::Machine& machine,
                             MotionStage motion)
    : port_(port), axes_(machine.axes), motion_(std::move(motion)) {}

Result<Frame> CommandedPort::read() noexcept {
  auto frame = port_.read();
  if (!frame) {
    return frame;
  }
  motion_.update(*frame, std::isfinite(frame->time_s));
  const double passed_s = frame->time_s - before_s_;
  double travel_mm2 = 0.0;
  for (std::size_t i = 0; i < axes_.size() && i < frame->axis_count; ++i) {
    auto& sample = frame->axis.at(i);
    const kernel::machine::Axis& axis = axes_[i];
    sample.command_mm = sample.actual_mm + ((1.0 - axis.feed_forward) * sample.velocity_mm_s +
                                            axis.velocity_lag_s * sample.acceleration_mm_s2) /
                                               axis.servo_gain_1_s;
    const double moved_mm = sample.command_mm - before_mm_.at(i);
    travel_mm2 += i < 3 ? moved_mm * moved_mm : 0.0;
    before_mm_.at(i) = sample.command_mm;
  }
  frame->path_speed_mm_s = started_ && passed_s > 0.0 ? std::sqrt(travel_mm2) / passed_s : 0.0;
  before_s_ = frame->time_s;
  started_ = true;
  return frame;
}

}  // namespace steadyrest::live
