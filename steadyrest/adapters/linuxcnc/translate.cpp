// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <cmath>
#include <cstdint>

#include <steadyrest/adapters/linuxcnc/translate.hpp>
#include <steadyrest/kernel/units/convert.hpp>

namespace steadyrest::adapters::linuxcnc {
namespace {

using kernel::signal::Frame;
using kernel::signal::Motion;
using kernel::signal::ProgramState;

constexpr double kMostSpindleFactor = 2.0;
constexpr double kSameRatio = 1e-6;

/// motion.motion-type. A tap and a thread show as feed: LinuxCNC itself ignores feed overrides
/// there.
Motion motion_of(const Sample& sample) noexcept {
  const double type = sample[Column::motion_type];
  if (sample[Column::enabled] == 0.0 || !(type >= 1.0 && type <= 6.0)) {
    return Motion::idle;
  }
  switch (static_cast<int>(type)) {
    case 1:
      return Motion::rapid;
    case 2:
    case 3:
      return Motion::feed;
    case 4:
      return Motion::tool_change;
    case 5:
      return Motion::probe;
    case 6:
      return Motion::rapid;  // a rotary axis is indexed
    default:
      return Motion::idle;
  }
}

/// By halui, up to 21 ms late.
ProgramState program_of(const Sample& sample) noexcept {
  if (sample[Column::mode_auto] == 0.0) {
    return ProgramState::stopped;
  }
  return sample[Column::program_paused] != 0.0    ? ProgramState::paused
         : sample[Column::program_running] != 0.0 ? ProgramState::running
                                                  : ProgramState::stopped;
}

/// What scales the active block's feed, whether or not M52 lets the layer in; without a block it is
/// what would. LinuxCNC multiplies what the axes permit of F (`requested`), but shows the product
/// with F itself (`feed`). Where F is within that, the quotient tells whether M52, M49 and M50 let
/// layer and panel in; with an F beyond, it tells nothing, and both are taken for let in.
double effective(const Sample& sample, const Units& units, double panel) noexcept {
  const double with_layer = panel * sample[Column::layer_feed];
  const double requested_mm_s = sample[Column::requested_speed] * units.linear_unit_mm;
  if (!(requested_mm_s > 0.0)) {
    return with_layer;
  }
  const double quotient = sample[Column::feed_mm_s] / requested_mm_s;
  for (const double ratio : {panel, sample[Column::layer_feed], 1.0, 0.0}) {
    if (std::abs(quotient - ratio) <= kSameRatio * ratio) {
      return ratio;
    }
  }
  return with_layer;
}

/// A machine axis's unit (mm or rad) in one of the control's units.
double unit_of(std::size_t axis, const Units& units) noexcept {
  return units.rotary[axis] ? kernel::units::rad_from_deg(1.0) : units.linear_unit_mm;
}

}  // namespace

Frame frame_of(const Sample& sample, const Units& units) noexcept {
  Frame frame;
  frame.time_s = static_cast<double>(sample.tick) * units.servo_period_s;
  frame.cycle = sample.tick;
  frame.axis_count = static_cast<std::uint8_t>(units.axes);
  for (std::size_t a = 0; a < units.axes; ++a) {
    const double scale = unit_of(a, units);
    frame.axis[a].command_mm = scale * sample.axis[a].command;
    frame.axis[a].actual_mm = scale * sample.axis[a].actual;
    frame.axis[a].following_error_mm = scale * sample.axis[a].following_error;
    frame.axis[a].offset_mm = scale * sample.axis[a].offset;
  }
  frame.motion = motion_of(sample);
  const double line = sample[Column::program_line];
  frame.program_line = line > 0.0 ? static_cast<std::uint32_t>(line) : 0;
  frame.program = program_of(sample);
  frame.speed_modulation = sample[Column::modulation] != 0.0;
  frame.path_speed_mm_s = sample[Column::path_speed] * units.linear_unit_mm;
  frame.programmed_feed_mm_s = sample[Column::requested_speed] * units.linear_unit_mm;

  const double feed_panel = sample[Column::feed_panel];
  const double rapid_panel = sample[Column::rapid_panel];
  const bool rapid = frame.motion == Motion::rapid;
  const double layer = sample[Column::layer_feed];
  frame.feed.panel_ratio = feed_panel;
  frame.feed.effective_ratio = rapid ? feed_panel * layer : effective(sample, units, feed_panel);
  frame.rapid.panel_ratio = rapid_panel;
  frame.rapid.effective_ratio = rapid ? effective(sample, units, rapid_panel) : rapid_panel * layer;

  const double spindle_panel = sample[Column::spindle_panel];
  const double out_rev_s = sample[Column::spindle_out_rev_s];
  frame.spindle.panel_ratio = spindle_panel;
  frame.spindle.effective_ratio = spindle_panel * sample[Column::layer_spindle];
  frame.spindle_programmed_rev_s = spindle_panel > 0.0 ? out_rev_s / spindle_panel : 0.0;
  frame.spindle_command_rev_s = out_rev_s * sample[Column::layer_spindle];
  frame.spindle_actual_rev_s = sample[Column::spindle_in_rev_s];
  return frame;
}

double feed_share(double ceiling_ratio, double panel_ratio) noexcept {
  const double panel = panel_ratio > 0.0 ? panel_ratio : 1.0;
  return std::clamp(ceiling_ratio / panel, 0.0, 1.0);
}

Pins pins_of(const kernel::signal::Command& command, const Sample& sample, const Units& units,
             const Pins& before) noexcept {
  Pins pins = before;
  pins.feed = command.feed_masks_panel && std::isfinite(command.feed_ratio)
                  ? std::clamp(command.feed_ratio, 0.0, kNoCeiling)
                  : kNoCeiling;
  const double spindle = command.spindle_ratio / sample[Column::spindle_panel];
  pins.spindle = command.spindle_masks_panel && std::isfinite(spindle)
                     ? std::clamp(spindle, 0.0, kMostSpindleFactor)
                     : 1.0;
  for (std::size_t a = 0; a < units.axes; ++a) {
    const double offset = command.offset_mm[a] / unit_of(a, units);
    const double path_offset = command.path_offset_mm[a] / unit_of(a, units);
    pins.offset[a] = std::isfinite(offset) ? offset : before.offset[a];
    pins.path_offset[a] = std::isfinite(path_offset) ? path_offset : 0.0;
  }
  return pins;
}

}  // namespace steadyrest::adapters::linuxcnc
