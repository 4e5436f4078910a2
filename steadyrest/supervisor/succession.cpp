// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <string>

#include <fmt/format.h>

#include <steadyrest/kernel/outcome/bad_input.hpp>
#include <steadyrest/supervisor/succession.hpp>

namespace steadyrest::supervisor {
namespace {

using kernel::machine::Axis;
using kernel::machine::Chatter;
using kernel::machine::Machine;
using kernel::machine::ThermalAxis;
using kernel::outcome::refuse;
using kernel::outcome::Result;

bool same_axis(const Axis& one, const Axis& other) {
  return one.name == other.name && one.rotary == other.rotary && one.present == other.present;
}

/// The filters' states have one place for each mode and each sensor.
bool same_shape(const ThermalAxis& one, const ThermalAxis& other) {
  return one.name == other.name && one.mode.size() == other.mode.size() &&
         one.ambient.size() == other.ambient.size();
}

/// What differs and may not; empty: nothing.
std::string misfit(const Machine& running, const Machine& wanted) {
  if (wanted.port != running.port) {
    return "the port differs";
  }
  if (!std::ranges::equal(wanted.axes, running.axes, same_axis)) {
    return "the axes differ in number, name or kind";
  }
  if (wanted.control.interpolator_period_s != running.control.interpolator_period_s) {
    return "[control] interpolator_period_ms differs";
  }
  if (wanted.control.servo_period_s != running.control.servo_period_s) {
    return "[control] servo_period_ms differs";
  }
  if (wanted.lines != running.lines || wanted.recorder != running.recorder) {
    return "[lines] or [recorder] differs";
  }
  if (wanted.opcua != running.opcua) {
    return "[opcua] differs";
  }
  if (wanted.envelope.stale_after_s != running.envelope.stale_after_s) {
    return "[envelope] stale_after_ms differs";
  }
  if (wanted.envelope.late_hold_s != running.envelope.late_hold_s) {
    return "[envelope] late_hold_ms differs";
  }
  if (wanted.feed_override != running.feed_override) {
    return "[override.feed] differs";
  }
  if (wanted.rapid_override != running.rapid_override) {
    return "[override.rapid] differs";
  }
  if (wanted.spindle_override != running.spindle_override) {
    return "[override.spindle] differs";
  }
  if (!std::ranges::equal(wanted.thermal.axis, running.thermal.axis, same_shape) ||
      wanted.thermal.sensors() != running.thermal.sensors()) {
    return "the thermal model differs in its axes, modes or sensors";
  }
  return {};
}

/// What an operator may change during a run.
bool same_modulation(const Chatter& one, const Chatter& other) noexcept {
  return one.law == other.law && one.amplitude_ratio == other.amplitude_ratio &&
         one.amplitude_rev_s == other.amplitude_rev_s && one.period_s == other.period_s &&
         one.mean_ratio == other.mean_ratio && one.seed == other.seed;
}

}  // namespace

Result<void> fits(const Machine& running, const Machine& wanted) {
  if (const std::string what = misfit(running, wanted); !what.empty()) {
    return refuse(wanted.file,
                  fmt::format("{} from the running layer's: it cannot change during a run", what),
                  "stop the layer and start it with the new file");
  }
  return {};
}

// Each room's settings are the sections that its make() reads.
Kept kept(const Machine& running, const Machine& wanted) noexcept {
  const bool axes = running.axes == wanted.axes;
  const bool limits =
      axes && running.envelope == wanted.envelope && running.control == wanted.control;
  return {
      .motion = axes,
      .contour = limits && running.contour == wanted.contour,
      .chatter = limits && running.chatter == wanted.chatter && running.spindle == wanted.spindle,
      .modulation = same_modulation(running.chatter, wanted.chatter),
      .thermal = limits && running.thermal == wanted.thermal && running.spindle == wanted.spindle};
}

}  // namespace steadyrest::supervisor
