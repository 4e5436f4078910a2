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
constexpr int kMostDisputes = 3;
constexpr double kDispute_s = 60.0;
constexpr double kStopped_s = 1.0;  ///< no program has run for so long
constexpr double kBeats_s = 1.0;    ///< another layer's heartbeat is heard for so long
/// Of the scan: the cycle's jitter.
constexpr double kTimeTolerance = 0.1;

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
  for (const std::uint32_t mask : {lines.feed.mask, lines.spindle.mask}) {
    if (mask < kMostLines) {
      masks_.set(mask);
    }
  }
}

LinesDevice::~LinesDevice() {
  if (acting_) {
    Levels outputs = on_wires_;
    release(outputs);
    [[maybe_unused]] const auto sent = parts_.wires->write(outputs);
  }
}

bool LinesDevice::settled(const OverrideLine& line) const noexcept {
  return parts_.wires->now_s() - since_s_ >= (1.0 - kTimeTolerance) * line.table().scan_period_s();
}

void LinesDevice::release(Levels& outputs) noexcept {
  for (auto* line : {&parts_.feed, &parts_.spindle}) {
    if (*line) {
      (*line)->release(settled(**line), outputs);
    }
  }
}

Result<void> LinesDevice::send(const Levels& outputs) {
  const bool changed = ((outputs ^ on_wires_) & words_).any();
  adopted_ = false;
  on_wires_ = outputs;
  const double begin_s = parts_.wires->now_s();
  auto written = parts_.wires->write(outputs);
  const double took_s = parts_.wires->now_s() - begin_s;
  sent_ = written.has_value();
  written_s_ = sent_ ? begin_s : written_s_;
  fastest_s_ = sent_ ? std::min(fastest_s_, took_s) : fastest_s_;
  if (changed) {
    // A slow write counts from its end, less what the next one takes at least.
    since_s_ = begin_s + std::max(0.0, took_s - fastest_s_);
  }
  return written;
}

Result<void> LinesDevice::check_outputs(const Levels& outputs) {
  const Levels differ = sent_ ? (outputs ^ on_wires_) & ours_ : Levels();
  differing_ = differ.any() ? differing_ + 1 : 0;
  silence_s_ = differing_ == 1 ? parts_.wires->now_s() - written_s_ : silence_s_;
  taken_ = taken_ || (sent_ && differ.none());
  if (differing_ < kDifferingReadings) {
    return {};
  }
  differing_ = 0;
  return dispute(outputs, differ);
}

Result<void> LinesDevice::dispute(const Levels& outputs, const Levels& differ) {
  const double now_s = parts_.wires->now_s();
  // By a watchdog, which takes all outputs off, or keeps the word and takes the masks.
  const bool expired = lines_.watchdog_s > 0.0 && silence_s_ > lines_.watchdog_s;
  const bool masks_alone = (outputs & masks_).none() && (differ & words_ & ~masks_).none();
  const bool dropped = taken_ && ((outputs & ours_).none() || (expired && masks_alone));
  if (!dropped) {
    disputes_ = disputes_ > 0 && now_s - dispute_s_ <= kDispute_s ? disputes_ + 1 : 1;
    dispute_s_ = now_s;
  }
  sent_ = false;
  const std::size_t line = differ._Find_first();
  const std::string what = fmt::format("output {} of the module is {}, but {} was written", line,
                                       outputs[line] ? "on" : "off", outputs[line] ? "off" : "on");
  const char* const why =
      "its watchdog has dropped the outputs, the line is stuck, or another "
      "client writes: steadyrest lines test";
  if (dropped || disputes_ < kMostDisputes) {
    parts_.wires->disconnect();  // a watchdog that has expired is cleared at a connection
    return unavailable(what, why);
  }
  let_go_ = unavailable(what + ", again and again: the layer has let go of the outputs",
                        std::string(why) + "; then start the layer again")
                .error();
  silent_ = kSilentReadings;
  on_wires_ = outputs;
  [[maybe_unused]] const auto released = pass_on();  // tried again at each reading
  return std::unexpected(*let_go_);
}

/// What must be written without an order: masks that nobody asks for, and the panel's word where
/// the layer is between panel and control. That goes out at each reading, turned or not: the
/// module's watchdog would drop it.
Result<void> LinesDevice::pass_on() {
  ++silent_;
  const bool ends = acting_ && silent_ > kSilentReadings;
  if (!ends && (acting_ || parts_.only_looks || lines_.wiring != Wiring::through)) {
    return {};
  }
  Levels outputs = on_wires_;
  release(outputs);
  auto sent = send(outputs);
  acting_ = acting_ && !sent;  // tried again
  // Nobody writes from here on, and a watchdog may drop the outputs.
  sent_ = sent_ && lines_.wiring == Wiring::through;
  return sent;
}

/// Goes on from outputs that are not known to be its own.
void LinesDevice::adopt(const Levels& outputs) noexcept {
  const Levels changed = outputs ^ on_wires_;
  const double now_s = parts_.wires->now_s();
  since_s_ = changed.none() ? since_s_ : now_s;
  const bool beats = lines_.heartbeat != kNoLine && changed[lines_.heartbeat];
  if (beats && adopted_ && (outputs & ours_).any()) {
    beaten_s_ = now_s;
  }
  adopted_ = true;
  taken_ = false;
  on_wires_ = outputs;
  for (auto* line : {&parts_.feed, &parts_.spindle}) {
    if (*line) {
      (*line)->adopt(outputs, is_old());
    }
  }
}

/// The machine has dropped what was written last: the process stood still, or the link.
bool LinesDevice::is_old() const noexcept {
  return parts_.wires->now_s() - written_s_ > parts_.holds_s;
}

/// The way back between two passes counts: each must be cut at one speed.
bool LinesDevice::in_thread(const Levels& inputs) noexcept {
  const double now_s = parts_.wires->now_s();
  if (lines_.locked < kMostLines && inputs[lines_.locked] != lines_.locked_inverted) {
    locked_s_ = now_s;
  }
  if (is_on(inputs, lines_.running)) {
    ran_s_ = now_s;
  }
  // A broken wire of an inverted input must not hold the overrides once no program runs.
  const bool stopped =
      lines_.running != kNoLine && now_s - ran_s_ > std::max(lines_.locked_hold_s, kStopped_s);
  return !stopped && now_s - locked_s_ <= lines_.locked_hold_s;
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
  if (auto as_written = let_go_ ? Result<void>() : check_outputs(outputs); !as_written) {
    return as_written;
  }
  sent_ = sent_ && !(acting_ && differing_ == 0 && is_old());
  if (!sent_ || let_go_) {
    adopt(outputs);
  }
  sample.in_thread = in_thread(sample.inputs);
  for (auto* line : {&parts_.feed, &parts_.spindle}) {
    if (*line) {
      (*line)->hold(sample.in_thread);
    }
  }
  if (parts_.feed) {
    sample.feed = parts_.feed->see(sample.inputs, outputs);
  }
  if (parts_.spindle) {
    sample.spindle = parts_.spindle->see(sample.inputs, outputs);
  }
  auto passed = pass_on();
  return let_go_ ? std::unexpected(*let_go_) : passed;
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
  if (let_go_) {
    return std::unexpected(*let_go_);
  }
  if (!acting_ && parts_.wires->now_s() - beaten_s_ < kBeats_s) {
    return unavailable(fmt::format("output {}, the heartbeat, changes though this layer does not "
                                   "act: another one acts on this module",
                                   lines_.heartbeat),
                       "stop the other one");
  }
  // Writing now would restore an old word and its mask in one step: the next reading starts afresh.
  const bool stood_still = acting_ && sent_ && is_old();
  acting_ = true;
  silent_ = 0;
  if (stood_still) {
    return {};
  }
  if (differing_ > 0) {
    // A write now would put word and mask back in one step; the next reading tells.
    return {};
  }
  Levels outputs = on_wires_;
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
