// SPDX-License-Identifier: Apache-2.0
#include <bit>
#include <cmath>

#include <steadyrest/kernel/units/constants.hpp>
#include <steadyrest/nc/interpret/control/coordinates.hpp>
#include <steadyrest/nc/interpret/control/worded_end.hpp>
#include <steadyrest/nc/interpret/state/frame.hpp>

namespace steadyrest::nc::interpret {
namespace {

// Machine and work coordinates; machine = R·work + offset, R the rotation in force about Z.

// G53: the named axes go to machine coordinates, the others stay. The tool length stays in force on
// SINUMERIK and is suppressed on the other controls.
Axes machine_end(const Step& step, const Control& control) {
  const State& state = control.state;
  Axes end = state.position;
  const bool keeps_tool = control.rules.tool_in_machine_frame;
  Axes machine = to_machine(state, state.position);
  for (std::size_t i = 0; i < kAxisLetters.size(); ++i) {
    if (step.has(kAxisLetters[i])) {
      machine[i] = component(step, i, state) +
                   (keeps_tool || tool_stays(control.rules, i) ? state.tool_offset[i] : 0.0);
    }
  }
  // In rotated coordinates, moving the machine's X or Y changes both in work coordinates, even if
  // the block names only one.
  const Axes work = to_work(state, machine);
  for (std::size_t i = 0; i < kAxisLetters.size(); ++i) {
    const bool turns = i < 2 && state.rotation_in_force_deg != 0.0;
    if (step.has(kAxisLetters[i]) || turns) {
      end[i] = is_wrapped(control, i)
                   ? within_turn(step[kAxisLetters[i]], work[i], state.position[i])
                   : work[i];
    }
  }
  return end;
}

}  // namespace

double within_turn(double written_deg, double wanted_deg, double now_deg) noexcept {
  constexpr double kTurn_deg = 360.0;
  const double end = std::abs(wanted_deg) + std::floor(now_deg / kTurn_deg) * kTurn_deg;
  if (std::signbit(written_deg)) {
    return end > now_deg ? end - kTurn_deg : end;
  }
  return end < now_deg ? end + kTurn_deg : end;
}

bool is_wrapped(const Control& control, std::size_t axis) noexcept {
  return (control.wrapped & Step::bit(kAxisLetters[axis])) != 0;
}

double component(const Step& step, std::size_t axis, const State& state) noexcept {
  const double value = step[kAxisLetters[axis]];
  // In G7 an X word is a diameter.
  const double scale = axis == 0 && state.diameter ? 0.5 * state.unit_mm : state.unit_mm;
  return is_rotary(axis) ? value : value * scale;
}

Axes to_machine(const State& state, const Axes& work) noexcept {
  Axes out = turned(work, state.rotation_in_force_deg);
  for (std::size_t i = 0; i < out.size(); ++i) {
    out[i] += state.offset[i];
  }
  return out;
}

Axes to_work(const State& state, const Axes& machine) noexcept {
  Axes out = machine;
  for (std::size_t i = 0; i < out.size(); ++i) {
    out[i] -= state.offset[i];
  }
  return turned(out, -state.rotation_in_force_deg);
}

// A change of offsets does not move the machine; the work position changes instead. The parts, from
// the machine inwards: settable offset and external offset, fine offset, the programmed frame
// turned by the settable rotation, G92 turned by both rotations, the tool.
void update_offset(State& state) noexcept {
  // Those of G54.1 P have no rotation.
  const bool numbered = state.work_offset_on && state.active_offset < kWorkOffsets;
  const double settable_deg = numbered ? state.rotation_deg[state.active_offset] : 0.0;
  const double rotation_deg = settable_deg + state.frame_rotation_deg;
  const Axes frame = turned(state.frame_shift, settable_deg);
  const bool turns = rotation_deg != 0.0 || state.rotation_in_force_deg != 0.0;
  const Axes machine = to_machine(state, state.position);
  const Axes g92 = turned(state.g92, rotation_deg);
  for (std::size_t i = 0; i < state.offset.size(); ++i) {
    const double work = state.work_offset_on ? state.work_in_force[i] : 0.0;
    // The tool offset is not rotated: tools are measured along the machine's axes.
    const double offset =
        work + state.external[i] + state.frame_fine[i] + frame[i] + g92[i] + state.tool_offset[i];
    // Without a rotation the difference is added instead of recomputing the position: no digit is
    // lost, however often offsets change.
    state.position[i] += state.offset[i] - offset;
    state.offset[i] = offset;
  }
  state.rotation_in_force_deg = rotation_deg;
  if (turns) {
    state.position = to_work(state, machine);
  }
}

bool tool_stays(const DialectRules& rules, std::size_t axis) noexcept {
  return rules.rotary_tool_in_machine_frame && is_rotary(axis);
}

void polar_point(const Step& step, const State& state, Axes& point) noexcept {
  using kernel::units::kDegree;
  // An omitted polar word keeps its present value; in G91 the words add to the present values. The
  // angle of +X is zero.
  double radius = std::hypot(point[0], point[1]);
  double angle = std::atan2(point[1], point[0]);
  if (!std::isnan(step.polar_radius)) {
    radius = step.polar_radius * state.unit_mm + (state.incremental ? radius : 0.0);
  }
  if (!std::isnan(step.polar_angle_deg)) {
    angle = step.polar_angle_deg * kDegree + (state.incremental ? angle : 0.0);
  }
  point[0] = radius * std::cos(angle);
  point[1] = radius * std::sin(angle);
}

// Where the block goes, in work coordinates; unnamed axes stay.
Axes end_point(const Step& step, const Control& control) noexcept {
  const State& state = control.state;
  if (step.machine_frame) {
    return machine_end(step, control);
  }
  if (has_worded_end(state)) {
    return worded_end(step, state);
  }
  Axes end = state.position;
  // Loops over the axis words present, not all nine axes: nearly all blocks have one to three.
  for (std::uint32_t left = step.mask & kAxisMask; left != 0; left &= left - 1) {
    const std::uint32_t bit = left & (~left + 1);
    const std::size_t i = kAxisOfLetter[static_cast<std::size_t>(std::countr_zero(left))];
    // AC( ) and IC( ) override G90 and G91 for their own word.
    const bool incremental =
        (step.incremental & bit) != 0 || (state.incremental && (step.absolute & bit) == 0);
    const double value = component(step, i, state);
    if (incremental) {
      end[i] = state.position[i] + value;
    } else {
      end[i] = is_wrapped(control, i) ? within_turn(value, value, state.position[i]) : value;
    }
  }
  if (step.polar) {
    end[0] = state.position[0];
    end[1] = state.position[1];
    polar_point(step, state, end);
  }
  return end;
}

}  // namespace steadyrest::nc::interpret
