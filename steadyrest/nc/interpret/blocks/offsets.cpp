// SPDX-License-Identifier: Apache-2.0
#include <cmath>

#include <steadyrest/nc/interpret/blocks/offsets.hpp>
#include <steadyrest/nc/interpret/control/coordinates.hpp>
#include <steadyrest/nc/interpret/control/tool_table.hpp>

namespace steadyrest::nc::interpret {

// G43 applies all of the tool's offsets, not only Z: LinuxCNC has X and others for lathes.
bool Offsets::tool_length(const Step& step) {
  switch (step.code(GGroup::tool_length)) {
    case g::kToolLength:
    case g::kAddToolLength: {
      // Without H it is the tool in the spindle, as on LinuxCNC.
      std::int32_t number = state_.tool_in_spindle;
      if (step.code(GGroup::tool_length) == g::kAddToolLength && !step.has('H')) {
        return refusals_.g_word(step, g::kAddToolLength, "tool_missing",
                                "G43.2 without the tool's number (H)");
      }
      if (step.has('H') && !tool_number(control_, step, 'H', number)) {
        return false;
      }
      const Tool* const tool = find_tool(control_.config, number);
      // G43.2 adds a second offset (a wear or correction offset) to the one in force.
      for (std::size_t i = 0; tool != nullptr && i < tool->offset.size(); ++i) {
        const double base =
            step.code(GGroup::tool_length) == g::kAddToolLength ? state_.tool_offset[i] : 0.0;
        const bool negative = step.has_fanuc && step.fanuc.negative_length;  // G44
        state_.tool_offset[i] = base + (negative ? -tool->offset[i] : tool->offset[i]);
      }
      break;
    }
    case g::kToolLengthByWords:
      for (std::size_t i = 0; i < kAxisLetters.size(); ++i) {
        if (step.has(kAxisLetters[i])) {
          state_.tool_offset[i] = component(step, i, state_);
        }
      }
      break;
    case g::kToolLengthOff:
      state_.tool_offset = {};
      break;
    default:
      return true;
  }
  update_offset(state_);
  return true;
}

bool Offsets::work_offset(const Step& step) {
  // The settable frame rotates the programmed one, so changing it would move the programmed frame:
  // refused.
  const int code = step.code(GGroup::work_offset);
  if ((step.zero_offset || code != kNoCode) &&
      (state_.frame_rotation_deg != 0.0 || state_.frame_shift != Axes{})) {
    constexpr int kNoOffset = 5000;  // G500
    return refusals_.g_word(step, step.zero_offset ? kNoOffset : code, "frame_and_offset",
                            "another settable offset while a programmed frame (TRANS, ROT) is in "
                            "force; cancel the frame first");
  }
  if (step.zero_offset) {
    state_.work_offset_on = false;
  } else if (code == g::kMoreOffsets) {
    const auto place = static_cast<std::size_t>(step.fanuc.offset) - 1;
    state_.work_in_force = place < state_.more_offsets.size() ? state_.more_offsets[place] : Axes{};
    state_.active_offset = kWorkOffsets + place;
    state_.work_offset_on = true;
  } else if (code != kNoCode) {
    const std::size_t active = place_of_offset(code);
    // LinuxCNC keeps its values when the system is already in force, even if the program has since
    // set its numbers (#5221 …).
    if (active != state_.active_offset || !state_.work_offset_on) {
      state_.work_in_force = state_.work_offset[active];
    }
    state_.active_offset = active;
    state_.work_offset_on = true;
  } else {
    return true;
  }
  // $P_IFRAME belongs to the offset in force: selecting an offset loads its stored frame, without
  // the fine part.
  state_.frame_fine = {};
  update_offset(state_);
  return true;
}

bool Offsets::origin(const Step& step, int code) {
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
      // A running control does not show the offset that G92.2 has put aside.
      if (control_.config.on_control && !control_.config.g92_on && !state_.g92_used) {
        return refusals_.g_word(step, code, "parameter_of_the_control",
                                "an offset that the control may have from before the program");
      }
      state_.g92 = state_.g92_stored;
      state_.g92_on = true;
      break;
    default:
      for (std::size_t i = 0; i < kAxisLetters.size(); ++i) {
        if (step.has(kAxisLetters[i])) {
          const double value = component(step, i, state_);
          // G52 sets the shift itself; G92 sets it so that the present position gets the given
          // value. They share one store.
          state_.g92[i] = code == g::kShift ? value : state_.g92[i] + state_.position[i] - value;
        }
      }
      // G92.3 brings this back after G92.2.
      state_.g92_stored = state_.g92;
      state_.g92_on = true;
      (code == g::kShift ? state_.g52_used : state_.g92_used) = true;
      break;
  }
  update_offset(state_);
  return true;
}

void Offsets::store_home(int code) noexcept {
  // G28.1 stores the machine position, so later offsets do not move it.
  Axes& home = state_.home[code == g::kStoreHome ? 0 : 1];
  home = to_machine(state_, state_.position);
  // An axis that counts in turns is stored as an angle within one.
  constexpr double kTurn_deg = 360.0;
  for (std::size_t i = 0; i < home.size(); ++i) {
    home[i] -= is_wrapped(control_, i) ? kTurn_deg * std::floor(home[i] / kTurn_deg) : 0.0;
  }
}

}  // namespace steadyrest::nc::interpret
