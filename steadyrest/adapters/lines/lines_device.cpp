// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <utility>

#include <fmt/format.h>

#include <steadyrest/adapters/lines/lines_device.hpp>
#include <steadyrest/kernel/outcome/bad_input.hpp>

namespace steadyrest::adapters::lines {
namespace {

using kernel::machine::kNoLine;
using kernel::machine::Lines;
using kernel::machine::Wiring;
using kernel::outcome::Result;
using kernel::outcome::unavailable;

constexpr int kSilentReadings = 3;
constexpr int kDifferingReadings = 2;
constexpr double kTimeTolerance = 1e-9;

Levels outputs_set(const Lines& lines) {
  Levels all;
  for (const std::uint32_t line : output_lines(lines)) {
    all.set(line);
  }
  return all;
}

bool is_in_force(const OverrideLine::Seen& seen) noexcept {
  return seen.effective_ratio < seen.panel_ratio || seen.effective_ratio > seen.panel_ratio;
}

}  // namespace

LinesDevice::LinesDevice(const Lines& lines, Parts parts)
    : lines_(lines), parts_(std::move(parts)), ours_(outputs_set(lines)), words_(ours_) {
  if (lines.heartbeat < kMostLines) {
    words_.reset(lines.heartbeat);
  }
}

LinesDevice::~LinesDevice() {
  if (acting_) {
    Levels outputs = on_wires_;
    release(outputs);
    [[maybe_unused]] const auto sent = parts_.wires->write(outputs);
  }
}

void LinesDevice::release(Levels& outputs) noexcept {
  if (parts_.feed) {
    parts_.feed->release(outputs);
  }
  if (parts_.spindle) {
    parts_.spindle->release(outputs);
  }
}

Result<void> LinesDevice::send(const Levels& outputs) {
  const bool changed = ((outputs ^ on_wires_) & words_).any();
  stood_s_ = changed ? 0.0 : stood_s_;
  on_wires_ = outputs;
  auto written = parts_.wires->write(outputs);
  sent_ = written.has_value();
  return written;
}

Result<void> LinesDevice::check_outputs(const Levels& outputs) {
  const Levels differ = sent_ ? (outputs ^ on_wires_) & ours_ : Levels();
  differing_ = differ.any() ? differing_ + 1 : 0;
  if (differing_ < kDifferingReadings) {
    return {};
  }
  differing_ = 0;
  sent_ = false;
  parts_.wires->disconnect();  // a watchdog that has expired is cleared at a connection
  const std::size_t line = differ._Find_first();
  return unavailable(
      fmt::format("output {} of the module is {}, but {} was written", line,
                  outputs[line] ? "on" : "off", outputs[line] ? "off" : "on"),
      "its watchdog has dropped the outputs, the line is stuck, or another client writes: "
      "steadyrest lines test");
}

/// What must be written without an order: masks that nobody asks for, and the panel's word where
/// the layer is between panel and control. That goes out at each reading, turned or not: the
/// module's watchdog would drop it.
Result<void> LinesDevice::pass_on() {
  ++silent_;
  const bool ends = acting_ && silent_ > kSilentReadings;
  if (!ends && (acting_ || lines_.wiring != Wiring::through)) {
    return {};
  }
  acting_ = false;
  Levels outputs = on_wires_;
  release(outputs);
  return send(outputs);
}

Result<void> LinesDevice::read_lines(LineSample& sample) {
  Levels outputs;
  if (auto got = parts_.wires->read(sample.inputs, outputs); !got) {
    sent_ = false;
    return got;
  }
  sample.read_s = kernel::link::monotonic_s();
  if (parts_.wires->connections() != connection_) {
    connection_ = parts_.wires->connections();
    sent_ = false;
  }
  if (auto as_written = check_outputs(outputs); !as_written) {
    return as_written;
  }
  if (!sent_) {
    on_wires_ = outputs;
    for (auto* line : {&parts_.feed, &parts_.spindle}) {
      if (*line) {
        (*line)->forget();
      }
    }
  }
  if (parts_.feed) {
    sample.feed = parts_.feed->see(sample.inputs, outputs);
  }
  if (parts_.spindle) {
    sample.spindle = parts_.spindle->see(sample.inputs, outputs);
  }
  return pass_on();
}

/// The encoders are read while the lines fail, too: a gap would end their positions for good.
Result<void> LinesDevice::read(LineSample& sample) {
  auto lines = read_lines(sample);
  if (parts_.encoders) {
    auto encoders = parts_.encoders->next();
    // With the layer's word in force the lines are shown without positions, so that the loop hands
    // back by its ramp; then the fault is told.
    if (lines && !encoders && !is_in_force(sample.feed) && !is_in_force(sample.spindle)) {
      return std::unexpected(std::move(encoders.error()));
    }
    sample.positions_known = encoders.has_value();
    if (encoders) {
      sample.encoders = *encoders;
    }
  }
  return lines;
}

Result<void> LinesDevice::write(const LineOrder& order) {
  acting_ = true;
  silent_ = 0;
  stood_s_ += lines_.cycle_s;
  if (differing_ > 0) {
    // A write now would put word and mask back in one step; the next reading tells.
    return {};
  }
  Levels outputs = on_wires_;
  const auto settled = [this](const OverrideLine& line) {
    return stood_s_ >= line.table().scan_period_s() - kTimeTolerance;
  };
  if (parts_.feed) {
    parts_.feed->put(order.feed, settled(*parts_.feed), outputs);
  }
  if (parts_.spindle) {
    parts_.spindle->put(order.spindle, settled(*parts_.spindle), outputs);
  }
  if (lines_.heartbeat != kNoLine) {
    outputs.flip(lines_.heartbeat);
  }
  return send(outputs);
}

}  // namespace steadyrest::adapters::lines
