// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

#include <fmt/format.h>

#include <steadyrest/adapters/lines/encoders/counter_encoders.hpp>
#include <steadyrest/adapters/lines/encoders/gpio_encoders.hpp>
#include <steadyrest/adapters/lines/encoders/serial_recorder.hpp>
#include <steadyrest/adapters/lines/lines_port.hpp>
#include <steadyrest/kernel/outcome/bad_input.hpp>

namespace steadyrest::adapters::lines {
namespace {

using kernel::machine::kNoLine;
using kernel::machine::Machine;
using kernel::machine::OverrideTable;
using kernel::machine::OverrideWires;
using kernel::machine::Recorder;
using kernel::machine::RecorderKind;
using kernel::machine::Wiring;
using kernel::outcome::refuse;
using kernel::outcome::Result;
using kernel::outcome::unavailable;
using kernel::signal::Frame;
using kernel::signal::Motion;
using kernel::signal::OverrideState;
using kernel::signal::ProgramState;

/// Beyond a module's and a recorder's longest answers, one after the other.
constexpr double kPatience = 3.0;

Result<std::optional<OverrideLine>> line_of(const OverrideWires& wires, const OverrideTable& table,
                                            Wiring wiring) {
  if (wires.out.empty()) {
    return std::nullopt;
  }
  auto made = OverrideLine::make({.wires = wires, .table = table, .wiring = wiring});
  if (!made) {
    return std::unexpected(std::move(made.error()));
  }
  return std::move(*made);
}

OverrideState state_of(const OverrideLine::Seen& seen) noexcept {
  return {.panel_ratio = seen.panel_ratio,
          .effective_ratio = seen.effective_ratio,
          .panel_code = seen.panel_code,
          .panel_code_known = seen.panel_known};
}

Word word_of_command(double ratio, std::uint32_t code, bool masks) noexcept {
  return {.code = code, .masks = masks && std::isfinite(ratio)};
}

Result<std::unique_ptr<EncoderSource>> open_encoders(const Recorder& recorder, double reply_s) {
  switch (recorder.kind) {
    case RecorderKind::gpio:
      return GpioEncoders::open(recorder);
    case RecorderKind::counter:
      return CounterEncoders::open(recorder);
    default:
      return SerialRecorder::open(recorder, reply_s);
  }
}

std::string name_of(const kernel::machine::Lines& lines) {
  using kernel::machine::LinesKind;
  switch (lines.kind) {
    case LinesKind::modbus_tcp:
      return "the module " + lines.address;
    case LinesKind::modbus_rtu:
      return "the module at " + lines.device;
    default:
      return lines.device;
  }
}

}  // namespace

Result<std::unique_ptr<LinesPort>> LinesPort::make(const Machine& machine,
                                                   std::unique_ptr<Wires> wires,
                                                   std::unique_ptr<EncoderSource> encoders,
                                                   Use use) {
  const auto& lines = machine.lines;
  auto feed = line_of(lines.feed, machine.feed_override, lines.wiring);
  auto spindle = line_of(lines.spindle, machine.spindle_override, lines.wiring);
  if (!feed || !spindle) {
    return std::unexpected(std::move(feed ? spindle.error() : feed.error()));
  }
  if (!*feed && !*spindle) {
    return refuse("[lines] wires no override", "add [lines.feed] or [lines.spindle]");
  }
  return std::unique_ptr<LinesPort>(
      new LinesPort(machine, {.wires = std::move(wires),
                              .encoders = std::move(encoders),
                              .feed = std::move(*feed),
                              .spindle = std::move(*spindle),
                              .holds_s = kernel::machine::holds_s(machine),
                              .only_looks = use == Use::looks}));
}

Result<std::unique_ptr<LinesPort>> LinesPort::open(const Machine& machine, Use use) {
  auto wires = open_wires(machine.lines);
  if (!wires) {
    return std::unexpected(std::move(wires.error()));
  }
  std::unique_ptr<EncoderSource> encoders;
  if (machine.recorder.fitted) {
    auto opened = open_encoders(machine.recorder, machine.lines.reply_s);
    if (!opened) {
      return std::unexpected(std::move(opened.error()));
    }
    encoders = std::move(*opened);
  }
  return make(machine, std::move(*wires), std::move(encoders), use);
}

LinesPort::LinesPort(const Machine& machine, LinesDevice::Parts parts)
    : lines_(machine.lines),
      axes_(machine.axes),
      start_count_(machine.axes.size()),
      encoders_(parts.encoders != nullptr ? encoder_count(machine) : 0),
      exchange_(name_of(machine.lines),
                std::make_unique<LinesDevice>(machine.lines, std::move(parts)),
                kPatience * machine.lines.reply_s) {
  for (std::size_t i = 0; i < axes_.size() && i < machine.recorder.start_mm.size(); ++i) {
    const double count_mm = axes_[i].encoder.count_au;
    start_count_[i] = count_mm > 0.0 ? std::llround(machine.recorder.start_mm[i] / count_mm) : 0;
  }
  if (encoders_ > 0 && machine.recorder.spindle_counts_rev > 0.0) {
    spindle_watch_.emplace(machine.recorder.spindle_counts_rev);
  }
}

kernel::port::Capability LinesPort::capability() const noexcept {
  // Words walk where their table says so; the module sets all outputs at once.
  return {.feed_override = !lines_.feed.out.empty(),
          .spindle_override = !lines_.spindle.out.empty(),
          .latched_word = true};
}

double LinesPort::position_mm(std::size_t axis, std::int64_t count) const noexcept {
  return axes_[axis].encoder.count_au * static_cast<double>(count);
}

/// The recorder's encoders are the present axes in the machine file's order, then the spindle.
void LinesPort::show_axes(const EncoderReading& encoders, Frame& frame) noexcept {
  const double passed_s = frame.time_s - before_s_;
  double travel_mm2 = 0.0;
  std::size_t counter = 0;
  for (std::size_t i = 0; i < axes_.size(); ++i) {
    if (!axes_[i].present || counter >= encoders.counters) {
      continue;
    }
    auto& axis = frame.axis.at(i);
    axis.encoder_shown = axes_[i].encoder.count_au > 0.0;
    axis.count = start_count_[i] + encoders.count.at(counter);
    axis.edge_s = encoders.edge_s.at(counter);
    axis.edge_direction = encoders.direction.at(counter);
    axis.actual_mm = position_mm(i, axis.count);
    axis.command_mm = axis.actual_mm;
    const double moved_mm = axis.actual_mm - before_mm_.at(i);
    travel_mm2 += i < 3 ? moved_mm * moved_mm : 0.0;
    before_mm_.at(i) = axis.actual_mm;
    ++counter;
  }
  frame.path_speed_mm_s = cycle_ > 1 && passed_s > 0.0 ? std::sqrt(travel_mm2) / passed_s : 0.0;
  before_s_ = frame.time_s;
}

void LinesPort::hide_axes(Frame& frame) const noexcept {
  for (std::size_t i = 0; i < axes_.size(); ++i) {
    frame.axis.at(i).actual_mm = std::numeric_limits<double>::quiet_NaN();
    frame.axis.at(i).command_mm = std::numeric_limits<double>::quiet_NaN();
  }
}

/// By the recorder's clock; without its samples by this computer's, from the last one on.
double LinesPort::time_of(const LineSample& sample) noexcept {
  if (encoders_ == 0) {
    return sample.read_s;
  }
  if (sample.positions_known) {
    recorder_ahead_s_ = sample.encoders.time_s - sample.read_s;
  }
  return sample.read_s + recorder_ahead_s_;
}

void LinesPort::show_spindle(const EncoderReading& encoders, Frame& frame) noexcept {
  const double ratio = frame.spindle.effective_ratio;
  frame.spindle_programmed_rev_s = lines_.programmed_rev_s;
  frame.spindle_actual_rev_s = lines_.programmed_rev_s * ratio;
  if (spindle_watch_ && encoders.counters > 0) {
    const auto count = static_cast<double>(encoders.count.at(encoders.counters - 1));
    spindle_watch_->update(frame.time_s, count, ratio);
    frame.spindle_actual_rev_s = spindle_watch_->actual_rev_s();
    if (lines_.programmed_rev_s <= 0.0) {
      frame.spindle_programmed_rev_s = spindle_watch_->programmed_rev_s();
    }
  }
  frame.spindle_command_rev_s = frame.spindle_programmed_rev_s * ratio;
}

/// What is not wired is taken for the most common case: a program that cuts.
void LinesPort::show_program(const LineSample& sample, Frame& frame) const noexcept {
  const Levels& inputs = sample.inputs;
  frame.motion = Motion::feed;
  if (lines_.running != kNoLine) {
    const bool runs = is_on(inputs, lines_.running);
    frame.program = runs ? ProgramState::running : ProgramState::stopped;
    frame.motion = runs ? Motion::feed : Motion::idle;
  }
  if (lines_.cutting != kNoLine && frame.motion == Motion::feed && !is_on(inputs, lines_.cutting)) {
    frame.motion = Motion::rapid;
  }
  if (sample.in_thread) {
    frame.motion = Motion::thread;
  }
  frame.speed_modulation = is_on(inputs, lines_.modulate);
}

Result<Frame> LinesPort::read() noexcept {
  auto taken = exchange_.read();
  if (!taken) {
    return std::unexpected(std::move(taken.error()));
  }
  const LineSample& sample = taken->sample;
  if (sample.positions_known && sample.encoders.counters != encoders_) {
    return unavailable(fmt::format("the recorder shows {} encoders; the machine file has {}",
                                   sample.encoders.counters, encoders_),
                       "the axes in the machine file's order, then the spindle if [recorder] has "
                       "spindle_counts_rev");
  }
  Frame frame;
  frame.cycle = ++cycle_;
  frame.age_s = taken->age_s;
  frame.axis_count = static_cast<std::uint8_t>(axes_.size());
  frame.time_s = time_of(sample);
  if (!lines_.feed.out.empty()) {
    frame.feed = state_of(sample.feed);
  }
  if (!lines_.spindle.out.empty()) {
    frame.spindle = state_of(sample.spindle);
  }
  show_program(sample, frame);
  if (!sample.positions_known) {
    hide_axes(frame);
  } else if (encoders_ > 0) {
    show_axes(sample.encoders, frame);
  }
  show_spindle(sample.encoders, frame);
  return frame;
}

Result<void> LinesPort::write(const kernel::signal::Command& command) noexcept {
  if (!command.write) {
    return refuse("a command that must not be written", "write in the mode act only");
  }
  return exchange_.write(
      {.feed = word_of_command(command.feed_ratio, command.feed_code, command.feed_masks_panel),
       .spindle = word_of_command(command.spindle_ratio, command.spindle_code,
                                  command.spindle_masks_panel)});
}

}  // namespace steadyrest::adapters::lines
