// SPDX-License-Identifier: Apache-2.0
#include <cmath>

#include <steadyrest/nc/interpret/blocks/interpreter.hpp>
#include <steadyrest/nc/interpret/state/frame.hpp>

// Modes, offsets and coordinate systems: what changes the meaning of positions without moving.
namespace steadyrest::nc::interpret {

bool Interpreter::set_modes(const Step& step) {
  if (step.code(GGroup::non_modal) == g::kDwell) {
    emit_dwell(step['P']);
  }
  const int plane = step.code(GGroup::plane);
  if (plane != kNoCode) {
    state_.plane = plane == g::kPlaneXy ? Plane::xy : plane == g::kPlaneZx ? Plane::zx : Plane::yz;
  }
  set_units(step);
  const int diameter = step.code(GGroup::lathe_diameter);
  if (diameter != kNoCode) {
    state_.diameter = diameter == g::kDiameter;
  }
  if (!set_cutter(step) || !set_tool_length(step) || !set_work_offset(step) ||
      !set_path_mode(step)) {
    return false;
  }
  const int distance = step.code(GGroup::distance);
  if (distance != kNoCode) {
    state_.incremental = distance == g::kIncremental;
  }
  const int centre = step.code(GGroup::arc_centre);
  if (centre != kNoCode) {
    state_.centre_absolute = centre == g::kCentreAbsolute;
  }
  const int retract = step.code(GGroup::retract);
  if (retract != kNoCode) {
    state_.retract_to_initial = retract == g::kRetractToInitial;
  }
  return true;
}

void Interpreter::set_units(const Step& step) {
  const int units = step.code(GGroup::units);
  if (units == kNoCode) {
    return;
  }
  state_.unit_mm = units == g::kInch ? kMmPerInch : 1.0;
  if (step.work_feed) {
    state_.feed_unit_mm = state_.unit_mm;
  }
}

Axes Interpreter::to_machine(const Axes& work) const noexcept {
  Axes out = turned(work, state_.rotation_in_force_deg);
  for (std::size_t i = 0; i < out.size(); ++i) {
    out[i] += state_.offset[i];
  }
  return out;
}

Axes Interpreter::to_work(const Axes& machine) const noexcept {
  Axes out = machine;
  for (std::size_t i = 0; i < out.size(); ++i) {
    out[i] -= state_.offset[i];
  }
  return turned(out, -state_.rotation_in_force_deg);
}

// The machine stays where it is when an offset changes: the work position takes the difference.
// machine = R·(position + g92) + work offset + frame + tool, R the rotation of the work offset and
// of sinumerik's programmed frame.
void Interpreter::update_offset() noexcept {
  const double settable_deg =
      state_.work_offset_on ? state_.rotation_deg[state_.active_offset] : 0.0;
  const double rotation_deg = settable_deg + state_.frame_rotation_deg;
  const Axes frame = turned(state_.frame_shift, settable_deg);
  const bool turns = rotation_deg != 0.0 || state_.rotation_in_force_deg != 0.0;
  const Axes machine = to_machine(state_.position);
  const Axes g92 = turned(state_.g92, rotation_deg);
  for (std::size_t i = 0; i < state_.offset.size(); ++i) {
    const double work = state_.work_offset_on ? state_.work_in_force[i] : 0.0;
    const double offset = work + state_.external[i] + state_.frame_fine[i] + frame[i] + g92[i] +
                          state_.tool_offset[i];
    state_.position[i] += state_.offset[i] - offset;
    state_.offset[i] = offset;
  }
  state_.rotation_in_force_deg = rotation_deg;
  if (turns) {
    state_.position = to_work(machine);
  }
}

bool Interpreter::set_tool_length(const Step& step) {
  switch (step.code(GGroup::tool_length)) {
    case g::kToolLength:
    case g::kAddToolLength: {
      std::int32_t number = state_.tool_in_spindle;
      if (step.code(GGroup::tool_length) == g::kAddToolLength && !step.has('H')) {
        return refuse_code(step, 'G', 43, "tool_missing", "G43.2 without the tool's number (H)");
      }
      if (step.has('H') && !tool_number(step, 'H', number)) {
        return false;
      }
      const Tool* const tool = find_tool(number);
      for (std::size_t i = 0; tool != nullptr && i < tool->offset.size(); ++i) {
        const double base =
            step.code(GGroup::tool_length) == g::kAddToolLength ? state_.tool_offset[i] : 0.0;
        state_.tool_offset[i] = base + tool->offset[i];
      }
      break;
    }
    case g::kToolLengthByWords:
      for (std::size_t i = 0; i < kAxisLetters.size(); ++i) {
        if (step.has(kAxisLetters[i])) {
          state_.tool_offset[i] = component(step, i);
        }
      }
      break;
    case g::kToolLengthOff:
      state_.tool_offset = {};
      break;
    default:
      return true;
  }
  update_offset();
  return true;
}

bool Interpreter::set_work_offset(const Step& step) {
  const int code = step.code(GGroup::work_offset);
  if ((step.zero_offset || code != kNoCode) &&
      (state_.frame_rotation_deg != 0.0 || state_.frame_shift != Axes{})) {
    return refuse_word(step.line, step.block->words().front(), "frame_and_offset",
                       "another settable offset while a programmed frame (TRANS, ROT) is in force; "
                       "take the frame back before");
  }
  if (step.zero_offset) {
    state_.work_offset_on = false;
  } else if (code != kNoCode) {
    const auto active = static_cast<std::size_t>(
        code <= g::kWorkOffset6 ? (code - g::kWorkOffset1) / 10 : 5 + (code - g::kWorkOffset6));
    // LinuxCNC goes on with what it has when the system is in force already, although a program may
    // have set its numbers (#5221 …) anew.
    if (active != state_.active_offset || !state_.work_offset_on) {
      state_.work_in_force = state_.work_offset[active];
    }
    state_.active_offset = active;
    state_.work_offset_on = true;
  } else {
    return true;
  }
  state_.frame_fine = {};
  update_offset();
  return true;
}

bool Interpreter::set_path_mode(const Step& step) {
  if (step.rounding_mm >= 0.0) {
    rounding_mm_ = step.rounding_mm;
  }
  switch (step.code(GGroup::path_mode)) {
    case g::kExactPath:
      state_.path_mode = PathMode::exact_path;
      state_.path_tolerance_mm = 0.0;
      break;
    case g::kExactStop:
      state_.path_mode = PathMode::exact_stop;
      state_.path_tolerance_mm = 0.0;
      break;
    case g::kContinuous:
      state_.path_mode = PathMode::continuous;
      // A negative P means "none given" on LinuxCNC.
      state_.path_tolerance_mm =
          step.has('P') && step['P'] > 0.0 ? step['P'] * state_.unit_mm : 0.0;
      break;
    default:
      break;
  }
  if (rules_->rounding_distance && state_.path_mode == PathMode::continuous) {
    state_.path_tolerance_mm = rounding_mm_;
  }
  return true;
}

bool Interpreter::non_modal(const Step& step) {
  const int code = step.code(GGroup::non_modal);
  switch (code) {
    case g::kSetData:
      return set_data(step);
    case g::kHome:
    case g::kSecondHome:
      return home(step, code == g::kHome ? 0 : 1);
    case g::kStoreHome:
    case g::kStoreSecondHome: {
      state_.home[code == g::kStoreHome ? 0 : 1] = to_machine(state_.position);
      return true;
    }
    case g::kShift:
    case g::kSetOrigin:
    case g::kForgetOrigin:
    case g::kOriginOff:
    case g::kOriginOn:
      return set_g92(step, code);
    default:
      return true;
  }
}

bool Interpreter::set_g92(const Step& step, int code) {
  switch (code) {
    case g::kForgetOrigin:
      state_.g92 = {};
      state_.g92_stored = {};
      state_.g92_on = false;
      break;
    case g::kOriginOff:
      state_.g92 = {};
      state_.g92_on = false;
      break;
    case g::kOriginOn:
      state_.g92 = state_.g92_stored;
      state_.g92_on = true;
      break;
    default:
      for (std::size_t i = 0; i < kAxisLetters.size(); ++i) {
        if (step.has(kAxisLetters[i])) {
          const double value = component(step, i);
          state_.g92[i] = code == g::kShift ? value : state_.g92[i] + state_.position[i] - value;
        }
      }
      state_.g92_stored = state_.g92;
      state_.g92_on = true;
      (code == g::kShift ? state_.g52_used : state_.g92_used) = true;
      break;
  }
  update_offset();
  return true;
}

}  // namespace steadyrest::nc::interpret
