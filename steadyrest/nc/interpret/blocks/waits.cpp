// SPDX-License-Identifier: Apache-2.0
#include <steadyrest/nc/interpret/blocks/waits.hpp>

namespace steadyrest::nc::interpret {
namespace {

bool changes_offset(const Step& step, const State& state) noexcept {
  const int code = step.code(GGroup::work_offset);
  return code != kNoCode && (!state.work_offset_on || place_of_offset(code) != state.active_offset);
}

bool sets_data_in_force(const Step& step, const State& state) noexcept {
  const bool system = step.has('L') && (step['L'] == 2.0 || step['L'] == 20.0);
  const auto in_force = static_cast<double>(state.active_offset + 1);
  return system && (!step.has('P') || step['P'] == 0.0 || step['P'] == in_force);
}

}  // namespace

bool waits_for_rest(const Step& step, const State& state) noexcept {
  if (step.has('S') || step.code(GGroup::tool_length) != kNoCode || changes_offset(step, state)) {
    return true;
  }
  switch (step.code(GGroup::non_modal)) {
    case g::kSetData:
      return sets_data_in_force(step, state);
    case g::kShift:
    case g::kSetOrigin:
    case g::kForgetOrigin:
    case g::kOriginOff:
    case g::kOriginOn:
      return true;
    default:
      break;
  }
  switch (step.code(MGroup::io)) {
    case m::kOutputOn:
    case m::kOutputOff:
    case m::kWaitForInput:
    case m::kAnalog:
      return true;
    default:
      break;
  }
  return step.code(MGroup::override_switch) == m::kAdaptiveFeed && step.has('P') &&
         step['P'] == 1.0;
}

}  // namespace steadyrest::nc::interpret
