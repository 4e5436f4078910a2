// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <array>
#include <cmath>

#include <steadyrest/nc/interpret/parameters/parameter_answers.hpp>
#include <steadyrest/nc/interpret/parameters/parameter_numbers.hpp>
#include <steadyrest/nc/interpret/parameters/parameters.hpp>
#include <steadyrest/nc/interpret/state/frame.hpp>

// The parameters that show the state itself.
namespace steadyrest::nc::interpret {

namespace {

/// Named parameters that show nothing of the program's state.
constexpr std::array<std::string_view, 6> kOfControl = {
    "_task", "_vmajor", "_vminor", "_speed_override", "_adaptive_feed", "_feed_hold"};

/// Of a number that of_state() answers.
Asked asked_by(int index, const Config& config) {
  Asked asked;
  if (within(index, kPosition)) {
    asked.about_position(static_cast<std::size_t>(index - kPosition));
  } else if (index == kActiveOffset) {
    asked.about_mode(mode(GGroup::work_offset));
  } else if (index == kTool) {
    asked.about_mode(kToolMode);
  } else if (index > kTool && index < kToolDiameter + 4) {
    asked.about_mode(kToolMode);
    if (!config.tools) {
      asked.about("#" + std::to_string(index));
    }
  } else if (!config.start_known) {
    asked.about("#" + std::to_string(index));
  }
  return asked;
}

Asked asked_by(std::string_view name, const Config& config) {
  constexpr std::string_view kLetters = "xyzabcuvw";
  Asked asked;
  const std::size_t axis = kLetters.find(name.back());
  if (name.size() == 2 && axis != std::string_view::npos) {
    asked.about_position(axis);
  } else if (name.starts_with("_abs_") && name.size() == 6 && axis != std::string_view::npos) {
    asked.about_position(axis);
    if (!config.start_known) {
      asked.about("#<" + std::string{name} + ">");
    }
  } else if (std::ranges::find(kOfControl, name) != kOfControl.end()) {
    // A preview reads the same program with _task 0 even where the machine is known.
    asked.about("#<" + std::string{name} + ">");
  } else if (const Answer* const answer = answer_of(name); answer != nullptr && answer->mode != 0) {
    asked.about_mode(answer->mode);
  }
  return asked;
}

}  // namespace

template <class Name>
void Parameters::take(const Asked& asked, const Name& name, double value, bool given) const {
  asked_.positions |= asked.positions;
  asked_.modes |= asked.modes;
  if (!asked.value.empty()) {
    asked_.about(asked.value);
  }
  asked_.any = asked_.any || asked.any;
  if (known_ == nullptr || (asked.value.empty() && (asked.positions & ~known_->axes) == 0 &&
                            (asked.modes & ~known_->modes) == 0)) {
    return;
  }
  if (given) {
    known_->heard = true;
  } else {
    known_->hear(name(), value);
  }
}

void Parameters::ask(int index, double value) const {
  const auto name = [index] { return "#" + std::to_string(index); };
  take(asked_by(index, *config_), name, value);
  // Given, but changed since by a value that is not known.
  if (known_ != nullptr && config_->start_known && !known_->offsets && index < kTool &&
      index != kActiveOffset) {
    known_->hear(name(), value);
  }
}

void Parameters::ask(std::string_view name, double value) const {
  take(
      asked_by(name, *config_), [name] { return "#<" + std::string{name} + ">"; }, value,
      name == "_task" && config_->on_machine);
}

// Numbers that a program may write although they show the state.
double* Parameters::stored(int index, bool& rotary) const noexcept {
  const auto axis_of = [&](int first, Axes& axes) {
    const auto axis = static_cast<std::size_t>(index - first);
    rotary = is_rotary(axis);
    return &axes[axis];
  };
  if (within(index, kHome)) {
    return axis_of(kHome, state_->home[0]);
  }
  if (within(index, kSecondHome)) {
    return axis_of(kSecondHome, state_->home[1]);
  }
  if (within(index, kG92)) {
    return axis_of(kG92, state_->g92_stored);
  }
  const int set = (index - kOffsets) / kOffsetStride;
  if (index >= kOffsets && set < static_cast<int>(kWorkOffsets)) {
    const int first = kOffsets + set * kOffsetStride;
    if (within(index, first)) {
      return axis_of(first, state_->work_offset[static_cast<std::size_t>(set)]);
    }
    if (index == first + kAxes) {
      rotary = true;
      return &state_->rotation_deg[static_cast<std::size_t>(set)];
    }
  }
  return nullptr;
}

// Under compensation LinuxCNC shows the tool's centre, not the contour.
Axes Parameters::position() const noexcept {
  Axes shown = state_->position;
  for (std::size_t i = 0; i < shown.size(); ++i) {
    shown[i] += state_->cutter_shift[i];
  }
  return shown;
}

bool Parameters::of_state(int index, double& value) const {
  const auto in_force = [&](const Axes& axes, int first, double unit_mm) {
    // Offsets, reference points and tool data in the units of the machine's files, positions in
    // those of the program; angles are degrees in both.
    const auto axis = static_cast<std::size_t>(index - first);
    value = axes[axis] / (is_rotary(axis) ? 1.0 : unit_mm);
    return true;
  };
  if (within(index, kPosition)) {
    return in_force(position(), kPosition, state_->unit_mm);
  }
  if (within(index, kToolOffset)) {
    return in_force(state_->tool.offset, kToolOffset, config_->data_unit_mm);
  }
  bool rotary = false;
  if (const double* const place = stored(index, rotary); place != nullptr) {
    value = rotary ? *place : *place / config_->data_unit_mm;
    return true;
  }
  switch (index) {
    case kG92InForce:
      value = state_->g92_on ? 1.0 : 0.0;
      return true;
    case kActiveOffset:
      value = static_cast<double>(state_->active_offset + 1);
      return true;
    case kTool:
      value = state_->tool_in_spindle;
      return true;
    case kToolDiameter:
      value = state_->tool.diameter_mm / config_->data_unit_mm;
      return true;
    case kToolDiameter + 1:
      value = state_->tool.front_angle_deg;
      return true;
    case kToolDiameter + 2:
      value = state_->tool.back_angle_deg;
      return true;
    case kToolDiameter + 3:
      value = state_->tool.orientation;
      return true;
    default:
      return false;
  }
}

// #<_x> and the like are work positions, #<_abs_x> machine positions; both in the program's unit.
bool Parameters::of_state(std::string_view name, double& value) const {
  if (name.size() == 2 && name[0] == '_') {
    constexpr std::string_view kLetters = "xyzabcuvw";
    if (const auto axis = kLetters.find(name[1]); axis != std::string_view::npos) {
      return of_state(kPosition + static_cast<int>(axis), value);
    }
  }
  if (name.starts_with("_abs_") && name.size() == 6) {
    constexpr std::string_view kLetters = "xyzabc";
    if (const auto axis = kLetters.find(name[5]); axis != std::string_view::npos) {
      const Axes machine = turned(position(), state_->rotation_in_force_deg);
      value = (machine[axis] + state_->offset[axis]) / (is_rotary(axis) ? 1.0 : state_->unit_mm);
      return true;
    }
  }
  if (name == "_line") {
    value = state_->line;
    return true;
  }
  if (name == "_value" || name == "_value_returned") {
    value = name == "_value" ? value_ : value_returned_;
    if (known_ != nullptr) {
      known_->heard = known_->heard || value_unknown_;
    }
    return true;
  }
  if (name == "_call_level") {
    value = static_cast<double>(calls_.size());
    return true;
  }
  if (name == "_task") {
    value = config_->on_control || config_->on_machine ? 1.0 : 0.0;
    return true;
  }
  const Answer* const answer = answer_of(name);
  if (answer != nullptr) {
    value = answer->value(*state_);
  }
  return answer != nullptr;
}

}  // namespace steadyrest::nc::interpret
