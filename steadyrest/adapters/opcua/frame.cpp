// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <cmath>

#include <steadyrest/adapters/opcua/frame.hpp>
#include <steadyrest/kernel/units/convert.hpp>

namespace steadyrest::adapters::opcua {
namespace {

using kernel::machine::Machine;
using kernel::machine::OpcUa;
using kernel::machine::Quantity;
using kernel::signal::Frame;
using kernel::signal::Motion;
using kernel::signal::OverrideState;
using kernel::signal::ProgramState;

constexpr double kPercent = 0.01;
constexpr double kPerMinute = 1.0 / 60.0;

bool has(const OpcUa& config, Quantity quantity) noexcept {
  return std::ranges::any_of(config.reads,
                             [=](const auto& place) { return place.quantity == quantity; });
}

/// G codes of group 1 by their number there, as the control counts them: G0 is 1, G33 is 10, G34
/// and G35 are 16 and 17, G335 and G336 20 and 21. Of the others only that they are feed matters.
/// NaN: no such number; a control that does not tell the group shows 0.
double code_of_number(double number) noexcept {
  constexpr std::array<double, kGroup1Codes + 1> kCodes = {NAN, 0,   1, 2, 3, 1,  1,  1, 1, 1,  33,
                                                           331, 332, 1, 1, 1, 34, 35, 1, 1, 33, 33};
  return number >= 1.0 && number < static_cast<double>(kCodes.size())
             ? kCodes[static_cast<std::size_t>(number)]
             : NAN;
}

Motion motion_of_code(double code) noexcept {
  if (code == 0.0) {
    return Motion::rapid;
  }
  if (code == 33.0 || code == 34.0 || code == 35.0) {
    return Motion::thread;
  }
  return code == 63.0 || code == 331.0 || code == 332.0 ? Motion::tap : Motion::feed;
}

OverrideState override_of(double panel_percent, double effective_percent) noexcept {
  OverrideState out;
  out.panel_ratio = kPercent * panel_percent;
  out.effective_ratio = kPercent * effective_percent;
  out.panel_code_known = std::isfinite(out.panel_ratio) && out.panel_ratio >= 0.0;
  return out;
}

/// Of a switch, 1 is the first; 0: the code is not in its table.
std::uint32_t position_of(std::uint32_t code,
                          const kernel::machine::OverrideTable& table) noexcept {
  const auto found = std::ranges::find(table.code, code);
  return found == table.code.end() ? 0 : static_cast<std::uint32_t>(found - table.code.begin()) + 1;
}

void put_axes(const Reading& reading, const Mapped& mapped, const Machine& machine,
              Frame& frame) noexcept {
  const std::size_t axes = std::min(machine.axes.size(), frame.axis.size());
  frame.axis_count = static_cast<std::uint8_t>(axes);
  for (std::size_t i = 0; i < axes; ++i) {
    auto& axis = frame.axis[i];
    if (!machine.axes[i].present) {
      continue;
    }
    const double unit = machine.axes[i].rotary ? kernel::units::rad_from_deg(1.0) : 1.0;
    axis.command_mm = unit * reading(Quantity::command_mm, i);
    axis.actual_mm = unit * reading(Quantity::actual_mm, i);
    axis.following_error_mm = mapped.following_error
                                  ? unit * reading(Quantity::following_error_mm, i)
                                  : axis.command_mm - axis.actual_mm;
    const double offset = unit * reading(Quantity::offset_mm, i);
    axis.offset_mm = std::isfinite(offset) ? offset : 0.0;
  }
}

}  // namespace

Mapped mapped(const OpcUa& config) noexcept {
  return {.feed_effective = has(config, Quantity::feed_effective_percent),
          .rapid = has(config, Quantity::rapid_panel_percent),
          .spindle = has(config, Quantity::spindle_panel_percent),
          .following_error = has(config, Quantity::following_error_mm),
          .motion = has(config, Quantity::motion_g) || has(config, Quantity::motion_number),
          .program_state = has(config, Quantity::program_state),
          .programmed_feed = has(config, Quantity::programmed_feed_mm_min),
          .spindle_speeds = has(config, Quantity::spindle_command_rpm)};
}

ProgramState program_state(const Reading& reading, const OpcUa& config) noexcept {
  const double shown = reading[Quantity::program_state];
  constexpr std::array<ProgramState, 3> kStates = {ProgramState::stopped, ProgramState::paused,
                                                   ProgramState::running};
  for (std::size_t i = 0; i < kStates.size(); ++i) {
    if (std::ranges::find(config.states[i], shown) != config.states[i].end()) {
      return kStates[i];
    }
  }
  return ProgramState::unknown;
}

Frame frame_of(const Reading& reading, const Mapped& mapped, const Machine& machine,
               const kernel::override::Table* feed_table) noexcept {
  Frame frame;
  put_axes(reading, mapped, machine, frame);
  const double panel = reading[Quantity::feed_panel_percent];
  frame.feed =
      override_of(panel, mapped.feed_effective ? reading[Quantity::feed_effective_percent] : panel);
  if (feed_table != nullptr && frame.feed.panel_code_known) {
    frame.feed.panel_code =
        feed_table->code(feed_table->nearest_step(frame.feed.panel_ratio).value_or(0));
  }
  if (mapped.rapid) {
    const double effective = reading[Quantity::rapid_effective_percent];
    const double rapid = reading[Quantity::rapid_panel_percent];
    frame.rapid = override_of(rapid, std::isfinite(effective) ? effective : rapid);
  }
  if (mapped.spindle) {
    const double effective = reading[Quantity::spindle_effective_percent];
    const double spindle = reading[Quantity::spindle_panel_percent];
    frame.spindle = override_of(spindle, std::isfinite(effective) ? effective : spindle);
  }
  const auto& config = machine.opcua;
  frame.program = mapped.program_state ? program_state(reading, config) : ProgramState::unknown;
  const double code = std::isfinite(reading[Quantity::motion_g])
                          ? reading[Quantity::motion_g]
                          : code_of_number(reading[Quantity::motion_number]);
  const bool at_rest = frame.program == ProgramState::stopped;
  // A motion that is not known may be a thread: the overrides are held.
  frame.motion = at_rest                ? Motion::idle
                 : !mapped.motion       ? Motion::feed
                 : !std::isfinite(code) ? Motion::thread
                                        : motion_of_code(code);
  const double line = reading[Quantity::program_line];
  frame.program_line = line > 0.0 && line < 4e9 ? static_cast<std::uint32_t>(line) : 0;
  frame.path_speed_mm_s = kPerMinute * reading[Quantity::path_speed_mm_min];
  const double effective = frame.feed.effective_ratio;
  frame.programmed_feed_mm_s = mapped.programmed_feed
                                   ? kPerMinute * reading[Quantity::programmed_feed_mm_min]
                               : effective > 0.0 ? frame.path_speed_mm_s / effective
                                                 : 0.0;
  if (mapped.spindle_speeds) {
    const double command = kPerMinute * reading[Quantity::spindle_command_rpm];
    const double programmed = kPerMinute * reading[Quantity::spindle_programmed_rpm];
    const double actual = kPerMinute * reading[Quantity::spindle_actual_rpm];
    frame.spindle_command_rev_s = command;
    frame.spindle_actual_rev_s = std::isfinite(actual) ? actual : command;
    const double ratio = frame.spindle.effective_ratio;
    frame.spindle_programmed_rev_s = std::isfinite(programmed) ? programmed
                                     : ratio > 0.0             ? command / ratio
                                                               : 0.0;
  }
  frame.coolant = reading[Quantity::coolant] > 0.0;
  frame.speed_modulation = reading[Quantity::modulation] > 0.0;
  return frame;
}

Order order_of(const kernel::signal::Command& command, const Machine& machine) noexcept {
  Order order;
  order.heartbeat = static_cast<std::uint32_t>(1 + command.heartbeat % kHeartbeats);
  order.masks_feed = command.feed_masks_panel && std::isfinite(command.feed_ratio);
  order.masks_spindle = command.spindle_masks_panel && std::isfinite(command.spindle_ratio);
  order.feed_percent = order.masks_feed ? command.feed_ratio / kPercent : 100.0;
  order.spindle_percent = order.masks_spindle ? command.spindle_ratio / kPercent : 100.0;
  order.feed_position =
      order.masks_feed ? position_of(command.feed_code, machine.feed_override) : 0;
  order.spindle_position =
      order.masks_spindle ? position_of(command.spindle_code, machine.spindle_override) : 0;
  order.has_offsets = machine.envelope.max_offset_mm > 0.0;
  for (std::size_t i = 0; i < machine.axes.size() && i < order.offset_mm.size(); ++i) {
    const double unit = machine.axes[i].rotary ? kernel::units::rad_from_deg(1.0) : 1.0;
    const double offset = command.offset_mm[i] / unit;
    order.has_offsets = order.has_offsets && std::isfinite(offset);
    order.offset_mm[i] = std::isfinite(offset) ? offset : 0.0;
  }
  return order;
}

}  // namespace steadyrest::adapters::opcua
