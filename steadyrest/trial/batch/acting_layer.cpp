// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <cmath>
#include <utility>

#include <steadyrest/trial/batch/acting_layer.hpp>

namespace steadyrest::trial::batch {

// The product's supervisor working on thermal offsets alone: same room, arbiter and envelope as on
// a machine. Hours pass quickly here, so frames are as rare as the watchdog allows.
using kernel::machine::Machine;
using kernel::outcome::Result;
using kernel::signal::Motion;

namespace {

constexpr std::uint64_t kFewestFrames = 16;   ///< of a second
constexpr std::uint64_t kMostFrames = 16384;  ///< `stale_after` is no shorter than 0.1 ms

/// A power of two, so that the frames' stamps are exact.
std::uint64_t frames_of_second(double stale_after_s) noexcept {
  std::uint64_t frames = kFewestFrames;
  while (frames < kMostFrames && static_cast<double>(frames) * stale_after_s < 1.0) {
    frames *= 2;
  }
  return frames;
}

}  // namespace

// The other rooms are off: only heat is under test, and they would need paths and vibration.
Result<ActingLayer> ActingLayer::make(const Machine& machine) {
  Machine thermal_alone = machine;
  thermal_alone.thermal.enabled = true;
  thermal_alone.contour.enabled = false;
  thermal_alone.chatter.enabled = false;
  auto layer = supervisor::Supervisor::make(thermal_alone, {.axis_offset = true});
  if (!layer) {
    return std::unexpected(std::move(layer.error()));
  }
  layer->set_mode(kernel::machine::Mode::act);
  return ActingLayer(machine, *std::move(layer));
}

ActingLayer::ActingLayer(const Machine& machine, supervisor::Supervisor layer)
    : layer_(std::move(layer)),
      frames_of_second_(frames_of_second(machine.envelope.stale_after_s)),
      sensors_(machine.thermal.sensors().size()) {
  frame_.axis_count = static_cast<std::uint8_t>(std::min(machine.axes.size(), frame_.axis.size()));
  for (std::size_t i = 0; i < frame_.axis_count; ++i) {
    // Any place within the limits will do; the frame check needs one.
    const double middle_mm = 0.5 * (machine.axes[i].min_au + machine.axes[i].max_au);
    frame_.axis[i].command_mm = frame_.axis[i].actual_mm =
        std::isfinite(middle_mm) ? middle_mm : 0.0;
  }
}

// The zero is set on the cold machine, as at the start of a shift.
void ActingLayer::begin(double room_c) noexcept {
  show({.room_c = room_c}, false);
  layer_.thermal()->zero_here();
}

void ActingLayer::pass(const Second& second) noexcept {
  const auto frames = static_cast<double>(frames_of_second_);
  // Turns the share of cutting into frames in the cut: the room sees motion, not shares.
  const auto cutting = static_cast<std::uint64_t>(std::lround(second.cutting * frames));
  for (std::uint64_t i = 0; i < frames_of_second_; ++i) {
    ++frame_.cycle;
    frame_.time_s = static_cast<double>(frame_.cycle) / frames;
    show(second, i < cutting);
  }
}

void ActingLayer::probe(std::size_t axis, double displacement_mm, double sd_mm) {
  const std::uint64_t last = probed_.empty() ? frame_.probe.number : probed_.back().number;
  probed_.push_back({.number = last + 1,
                     .axis = static_cast<std::uint8_t>(axis),
                     .displacement_mm = displacement_mm,
                     .sd_mm = sd_mm});
}

void ActingLayer::show(const Second& second, bool cuts) noexcept {
  frame_.motion = cuts ? Motion::feed : Motion::idle;
  frame_.spindle_programmed_rev_s = frame_.spindle_actual_rev_s = second.speed_rev_s;
  frame_.path_speed_mm_s = second.feed_mm_s;
  frame_.coolant = second.coolant;
  std::fill_n(frame_.temperature_c.begin(), sensors_, second.room_c);
  if (!probed_.empty()) {
    // One reading per frame: each has its own number and is taken once.
    frame_.probe = probed_.front();
    probed_.erase(probed_.begin());
  }
  const kernel::signal::Command command = layer_.update(frame_);
  if (command.write) {
    offset_mm_ = command.offset_mm;
  }
}

}  // namespace steadyrest::trial::batch
