// SPDX-License-Identifier: Apache-2.0
#include <cmath>

#include <steadyrest/nc/interpret/blocks/offset_data.hpp>
#include <steadyrest/nc/interpret/control/coordinates.hpp>
#include <steadyrest/nc/interpret/control/tool_table.hpp>
#include <steadyrest/nc/interpret/state/frame.hpp>

namespace steadyrest::nc::interpret {

bool OffsetData::set(const Step& step) {
  // L is the form; −1 is none of them.
  const double form = step.has('L') ? step['L'] : -1.0;
  if (control_.rules.g10_adds) {
    return added_work(step, form);
  }
  if (form == 2.0 || form == 20.0) {
    return work(step, form);
  }
  if (form == 1.0 || form == 10.0 || form == 11.0) {
    return tool(step, form);
  }
  return refusals_.g_word(
      step, g::kSetData, "g10_form",
      "this form of G10 is not interpreted; L1, L10, L11 (tool table), L2 and L20 "
      "(work offsets) are");
}

bool OffsetData::work(const Step& step, double form) {
  const double number = step.has('P') ? step['P'] : -1.0;
  if (number != std::floor(number) || number < 0.0 || number > 9.0) {
    return refusals_.g_word(step, g::kSetData, "g10_form",
                            "G10 names no work offset; P0 (active) to P9 (G59.3) are allowed");
  }
  if (step.has('R') && form == 20.0) {
    // L20 computes the offset for a given rotation; a new rotation in the same words would leave
    // one equation with two unknowns.
    return refusals_.letter(step, 'R', "g10_form", "a rotation (R) in G10 L20; G10 L2 takes one");
  }
  if (!state_.work_offset_on && number == 0.0) {
    return refusals_.g_word(step, g::kSetData, "g10_form", "no work offset is active");
  }
  const std::size_t set =
      number == 0.0 ? state_.active_offset : static_cast<std::size_t>(number) - 1;
  Axes& offset = state_.work_offset[set];
  if (step.has('R')) {
    state_.rotation_deg[set] = step['R'];
  }
  if (form == 2.0) {
    // Inactive systems change silently: they act when selected.
    for (std::size_t i = 0; i < kAxisLetters.size(); ++i) {
      if (step.has(kAxisLetters[i])) {
        offset[i] = component(step, i, state_);
      }
    }
  } else {
    place_here(step, state_.rotation_deg[set], offset);
  }
  if (set != state_.active_offset) {
    return true;
  }
  // Needed below: where the machine is, the old offset, and the position along the machine's axes.
  const Axes machine = to_machine(state_, out_.place());
  const Axes before = state_.work_in_force;
  state_.work_in_force = offset;
  const double before_deg = state_.rotation_in_force_deg;
  Axes place = turned(state_.position, before_deg);
  update_offset(state_);
  // LinuxCNC 2.9 ignores G92 when the rotation changes: from then on its X and Y differ from the
  // machine's, and an axis that is not programmed goes there.
  if (state_.rotation_in_force_deg != before_deg) {
    for (std::size_t i = 0; i < place.size(); ++i) {
      place[i] += before[i] - offset[i];
    }
    place = turned(place, -state_.rotation_in_force_deg);
    state_.position[0] = place[0];
    state_.position[1] = place[1];
    stand_at_machine(machine);
  }
  return true;
}

void OffsetData::stand_at_machine(const Axes& machine) {
  constexpr double kSame_mm = 1e-9;
  const Axes place = to_work(state_, machine);
  if (std::abs(place[0] - state_.position[0]) > kSame_mm ||
      std::abs(place[1] - state_.position[1]) > kSame_mm) {
    out_.stand_at(place);
  }
}

// L10 to L13: lengths and radii of tools. Without a tool table every tool has length 0 in this
// reading, and moves are those of the tip, so nothing follows from them.
bool OffsetData::set_tool_register(const Step& step, double form) {
  const double number = step.has('P') ? step['P'] : -1.0;
  if (number != std::floor(number) || number < 1.0 || number >= 1e6 || !step.has('R')) {
    return refusals_.g_word(step, g::kSetData, "g10_form",
                            "G10 L10 to L13 need the register's number (P) and value (R)");
  }
  constexpr double kLength = 10.0;
  if (form != kLength && !control_.config.tools) {
    return true;
  }
  if (form != kLength) {
    return refusals_.g_word(step, g::kSetData, "g10_form",
                            "wear and radii (G10 L11 to L13) are not interpreted beside a tool "
                            "table; L10 is");
  }
  Tool* const tool = place_of_tool(control_.config, static_cast<std::int32_t>(number));
  if (tool == nullptr) {
    return !control_.config.tools ||
           refusals_.g_word(step, g::kSetData, "no_such_tool",
                            "G10 names a tool (P) that is not in the tool table");
  }
  const double length = step['R'] * state_.unit_mm;
  tool->offset[2] = length + (state_.incremental ? tool->offset[2] : 0.0);
  return true;
}

// L20 P1 …: the offsets of G54.1 P, kept in order and 0 until they are set.
bool OffsetData::set_more_offsets(const Step& step) {
  constexpr double kMost = 300.0;
  const double number = step.has('P') ? step['P'] : -1.0;
  if (number != std::floor(number) || number < 1.0 || number > kMost) {
    return refusals_.g_word(step, g::kSetData, "g10_form",
                            "G10 L20 names no additional work offset; P1 to P300 are allowed");
  }
  const auto place = static_cast<std::size_t>(number) - 1;
  if (state_.more_offsets.size() <= place) {
    state_.more_offsets.resize(place + 1);
  }
  Axes& offset = state_.more_offsets[place];
  add_words(step, offset);
  if (state_.active_offset == kWorkOffsets + place) {
    state_.work_in_force = offset;
  }
  update_offset(state_);
  return true;
}

// G91 adds instead of replacing, so corrections can be written without knowing the value.
void OffsetData::add_words(const Step& step, Axes& offset) const {
  for (std::size_t i = 0; i < kAxisLetters.size(); ++i) {
    if (step.has(kAxisLetters[i])) {
      offset[i] = component(step, i, state_) + (state_.incremental ? offset[i] : 0.0);
    }
  }
}

// L2: P1 to P6 are G54 to G59, P0 is the external offset added to all of them; on a Haas P0
// is G52. In G91 the words are added to the offset.
bool OffsetData::added_work(const Step& step, double form) {
  if (form >= 10.0 && form <= 13.0) {
    return set_tool_register(step, form);
  }
  if (form == 20.0) {
    return set_more_offsets(step);
  }
  if (form != 2.0) {
    return refusals_.g_word(step, g::kSetData, "g10_form",
                            "this form of G10 is not interpreted; L2 and L20 (work offsets) and "
                            "L10 to L13 (tools) are");
  }
  const double number = step.has('P') ? step['P'] : -1.0;
  if (number != std::floor(number) || number < 0.0 || number > 6.0) {
    return refusals_.g_word(step, g::kSetData, "g10_form",
                            "G10 L2 names no work offset; P0 (external) to P6 (G59) are allowed");
  }
  if (number == 0.0 && !(control_.config.external_offset && control_.rules.external_offset)) {
    return refusals_.g_word(step, g::kSetData, "g10_form",
                            "G10 L2 P0 is G52 on this control; write G52");
  }
  if (step.has('R')) {
    return refusals_.letter(step, 'R', "unused_word", "an R word with G10 L2");
  }
  Axes& offset =
      number == 0.0 ? state_.external : state_.work_offset[static_cast<std::size_t>(number) - 1];
  add_words(step, offset);
  if (number == static_cast<double>(state_.active_offset) + 1.0) {
    state_.work_in_force = offset;
  }
  update_offset(state_);
  return true;
}

// L20: sets `offset` so that the present position reads as the words say, in the rotated
// coordinates.
void OffsetData::place_here(const Step& step, double rotation_deg, Axes& offset) const {
  // machine = offset + R·(position + G92) + tool, solved for the offset.
  const Axes machine = to_machine(state_, state_.position);
  if (rotation_deg == 0.0) {
    for (std::size_t i = 0; i < kAxisLetters.size(); ++i) {
      if (step.has(kAxisLetters[i])) {
        offset[i] = machine[i] - state_.g92[i] - state_.tool_offset[i] - component(step, i, state_);
      }
    }
    return;
  }
  // With a rotation the unknown offset is turned into the work axes: each named axis gives one
  // equation there, and the others stay.
  Axes from_origin{};
  for (std::size_t i = 0; i < from_origin.size(); ++i) {
    from_origin[i] = machine[i] - state_.tool_offset[i] - offset[i];
  }
  Axes shift = turned(from_origin, -rotation_deg);
  for (std::size_t i = 0; i < kAxisLetters.size(); ++i) {
    shift[i] =
        step.has(kAxisLetters[i]) ? shift[i] - state_.g92[i] - component(step, i, state_) : 0.0;
  }
  shift = turned(shift, rotation_deg);
  for (std::size_t i = 0; i < shift.size(); ++i) {
    offset[i] += shift[i];
  }
}

// L10 in rotated coordinates: an unnamed X or Y stays where the tool's old data put it.
void OffsetData::place_tool(const Step& step, const Axes& machine, const Axes& frame,
                            double turn_deg, Tool& tool) const {
  Axes tip{};
  for (std::size_t i = 0; i < 2; ++i) {
    // Where the tip is now, from the origin of the work offset, along the machine's axes; then
    // turned into the work axes.
    tip[i] = machine[i] - frame[i] - tool.offset[i];
  }
  tip = turned(tip, -turn_deg);
  for (std::size_t i = 0; i < 2; ++i) {
    if (step.has(kAxisLetters[i])) {
      tip[i] = component(step, i, state_) + state_.g92[i];
    }
  }
  tip = turned(tip, turn_deg);
  for (std::size_t i = 0; i < 2; ++i) {
    tool.offset[i] = machine[i] - frame[i] - tip[i];
  }
}

// L1 sets a tool's data; L10 and L11 set them so that the tip would be at the given place in the
// present work offset or in G59.3. The next G43 puts them in force.
bool OffsetData::tool(const Step& step, double form) {
  const double number = step.has('P') ? step['P'] : -1.0;
  Tool* const place = number == std::floor(number) && number > 0.0 && number < 1e6
                          ? place_of_tool(control_.config, static_cast<std::int32_t>(number))
                          : nullptr;
  if (place == nullptr) {
    return refusals_.g_word(step, g::kSetData, "no_such_tool",
                            "G10 names a tool (P) that is not in the tool table");
  }
  constexpr std::size_t kFixtures = 8;  // G59.3
  // L11 measures against a fixture on the table, located by G59.3: independent of the part's
  // offset.
  const Axes& frame = form == 11.0 ? state_.work_offset[kFixtures] : state_.work_in_force;
  const Axes machine = to_machine(state_, state_.position);
  const double turn_deg = form == 10.0 ? state_.rotation_in_force_deg : 0.0;
  // X and Y together, since the rotation mixes them; the other axes one by one below.
  if (turn_deg != 0.0) {
    place_tool(step, machine, frame, turn_deg, *place);
  }
  for (std::size_t i = 0; i < kAxisLetters.size(); ++i) {
    if (!step.has(kAxisLetters[i]) || (turn_deg != 0.0 && i < 2)) {
      continue;
    }
    const double value = component(step, i, state_);
    const double shift = form == 10.0 ? state_.g92[i] : 0.0;
    place->offset[i] = form == 1.0 ? value : machine[i] - frame[i] - shift - value;
  }
  if (step.has('R')) {
    place->diameter_mm = 2.0 * step['R'] * state_.unit_mm;
  }
  if (step.has('I')) {
    place->front_angle_deg = step['I'];
  }
  if (step.has('J')) {
    place->back_angle_deg = step['J'];
  }
  if (step.has('Q')) {
    if (step['Q'] != std::floor(step['Q']) || step['Q'] < 0.0 || step['Q'] > 9.0) {
      return refusals_.letter(step, 'Q', "out_of_range",
                              "a lathe tool's orientation (Q) is out of range; allowed: 0 to 9");
    }
    place->orientation = static_cast<std::int32_t>(step['Q']);
  }
  // The tool in the spindle uses its new data from here on; its length acts at the next G43.
  if (place->number == state_.tool_in_spindle) {
    load_tool(control_);
  }
  return true;
}

}  // namespace steadyrest::nc::interpret
