// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <cmath>
#include <random>
#include <utility>

#include <steadyrest/adapters/opcua/opcua_port.hpp>
#include <steadyrest/kernel/outcome/bad_input.hpp>

namespace steadyrest::adapters::opcua {
namespace {

using kernel::machine::Machine;
using kernel::machine::OpcUa;
using kernel::machine::Quantity;
using kernel::outcome::refuse;
using kernel::outcome::Result;

constexpr double kHeeds_s = 1.0;
constexpr double kDeadMen = 3.0;

bool writes(const OpcUa& config, Quantity quantity) noexcept {
  return std::ranges::any_of(config.writes,
                             [=](const auto& place) { return place.quantity == quantity; });
}

}  // namespace

Result<std::unique_ptr<OpcUaPort>> OpcUaPort::make(const Machine& machine,
                                                   std::unique_ptr<Device> device) {
  if (machine.axes.empty() || machine.axes.size() > kernel::signal::kMaxAxes) {
    return refuse("number of axes (allowed: 1 to 8)", "give the axes of the machine file");
  }
  if (machine.opcua.reads.empty()) {
    return refuse(machine.file, "the mapping of the control's nodes is empty",
                  "name a mapping in [opcua], e.g. examples/opcua/sinumerik-840d-sl.toml");
  }
  std::optional<kernel::override::Table> table;
  if (!machine.feed_override.ratio.empty()) {
    auto made = kernel::override::Table::make(machine.feed_override);
    if (!made) {
      return std::unexpected(std::move(made.error()));
    }
    table = *std::move(made);
  }
  return std::unique_ptr<OpcUaPort>(new OpcUaPort(machine, std::move(table), std::move(device)));
}

OpcUaPort::OpcUaPort(const Machine& machine, std::optional<kernel::override::Table> feed_table,
                     std::unique_ptr<Device> device)
    : machine_(machine),
      mapped_(mapped(machine.opcua)),
      feed_table_(std::move(feed_table)),
      first_heartbeat_(std::random_device()() % kHeartbeats),
      beats_in_bytes_(writes(machine.opcua, Quantity::heartbeat_byte)),
      orders_(beats_in_bytes_ ? kHeartbeatBytes : kHeartbeats),
      exchange_("the control's OPC UA server", std::move(device), machine.opcua.reply_s) {
  const OpcUa& config = machine_.opcua;
  capability_ = {.feed_override = writes(config, Quantity::feed_percent) ||
                                  writes(config, Quantity::feed_position),
                 .spindle_override = (writes(config, Quantity::spindle_percent) ||
                                      writes(config, Quantity::spindle_position)) &&
                                     machine_.spindle_override.ratio.size() > 1,
                 .axis_offset = writes(config, Quantity::axis_offset_mm) &&
                                machine_.envelope.max_offset_mm > 0.0,
                 .path_offset = false,
                 .latched_word = true};
}

kernel::port::Capability OpcUaPort::capability() const noexcept {
  return capability_;
}

double OpcUaPort::time_of(const Reading& reading) noexcept {
  double shown_s = reading[Quantity::time_s];
  if (!std::isfinite(shown_s)) {
    shown_s = reading.source_s;
  }
  if (!std::isfinite(shown_s)) {
    return shown_s;
  }
  if (cycle_ > 0 && shown_s + shift_s_ < last_s_) {
    // It was started again, or its number has overflowed.
    shift_s_ = last_s_ + machine_.opcua.cycle_s - shown_s;
  }
  last_s_ = shown_s + shift_s_;
  return last_s_;
}

Result<void> OpcUaPort::check_alone() const noexcept {
  if (!orders_.other()) {
    return {};
  }
  return kernel::outcome::unavailable(
      "the control takes orders of another layer: this one has let go of it",
      "stop the other one, then start this one again");
}

Result<void> OpcUaPort::check_heeded() const noexcept {
  if (unheeded_s_ < kHeeds_s + kDeadMen * machine_.opcua.dead_man_s) {
    return {};
  }
  return kernel::outcome::unavailable(
      "the control takes none of the layer's orders",
      "see node, index and scale of each [[write]] in the mapping, and load the texts that "
      "steadyrest opcua texts makes of this very machine file");
}

Result<kernel::signal::Frame> OpcUaPort::read() noexcept {
  auto taken = exchange_.read();
  if (!taken) {
    in_force_.store(-1);
    return std::unexpected(std::move(taken.error()));
  }
  const Reading& reading = taken->sample;
  orders_.seen(reading[Quantity::heartbeat_seen]);
  if (auto alone = check_alone(); !alone) {
    in_force_.store(-1);
    return std::unexpected(std::move(alone.error()));
  }
  kernel::signal::Frame frame =
      frame_of(reading, mapped_, machine_, feed_table_ ? &*feed_table_ : nullptr);
  frame.time_s = time_of(reading);
  frame.age_s = taken->age_s;
  frame.cycle = ++cycle_;
  const double alive = reading[Quantity::layer_alive];
  in_force_.store(std::isfinite(alive) ? (alive > 0.0 ? 1 : 0) : -1);
  // A mapping without it shows nothing.
  const bool heeded = !std::isfinite(alive) || alive > 0.0;
  if (heeded) {
    unheeded_s_ = 0.0;
  } else if (std::exchange(ordered_, false)) {
    unheeded_s_ += machine_.opcua.cycle_s;
  }
  program_.store({.name = reading.program, .state = frame.program});
  return frame;
}

Result<void> OpcUaPort::write(const kernel::signal::Command& command) noexcept {
  if (!command.write) {
    return refuse("a command that must not be written", "write in the mode act only");
  }
  if (auto alone = check_alone(); !alone) {
    return alone;
  }
  Order order = order_of(command, machine_);
  order.heartbeat = 1 + (order.heartbeat + first_heartbeat_) % kHeartbeats;
  order.masks_feed = order.masks_feed && capability_.feed_override;
  order.masks_spindle = order.masks_spindle && capability_.spindle_override;
  order.has_offsets = order.has_offsets && capability_.axis_offset;
  orders_.sent(beats_in_bytes_ ? heartbeat_byte(order.heartbeat) : order.heartbeat);
  ordered_ = true;
  if (auto written = exchange_.write(order); !written) {
    return written;
  }
  return check_heeded();
}

std::optional<bool> OpcUaPort::in_force() const noexcept {
  const int known = in_force_.load();
  return known < 0 ? std::nullopt : std::optional(known > 0);
}

}  // namespace steadyrest::adapters::opcua
