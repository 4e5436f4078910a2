// SPDX-License-Identifier: Apache-2.0
#include <cmath>
#include <limits>

#include <steadyrest/nc/interpret/parameters/macro_variables.hpp>
#include <steadyrest/nc/interpret/state/step.hpp>

namespace steadyrest::nc::interpret {
namespace {

using read::Lookup;

// Locals, volatile commons and permanent commons of FANUC's custom macro. All start vacant here:
// values kept from earlier programs are unknown.
constexpr bool is_kept(int index) noexcept {
  return (index >= 1 && index <= 33) || (index >= 100 && index <= 199) ||
         (index >= 500 && index <= 999);
}

/// The mode that #4001 … show.
constexpr ModeMask mode_of(int index) noexcept {
  switch (index) {
    case 4001:
    case 4009:
      return mode(GGroup::motion);
    case 4002:
      return mode(GGroup::plane);
    case 4003:
      return mode(GGroup::distance);
    case 4005:
      return mode(GGroup::feed_mode);
    case 4006:
      return mode(GGroup::units);
    case 4010:
      return mode(GGroup::retract);
    case 4014:
      return mode(GGroup::work_offset);
    case 4109:
      return kFeedMode;
    case 4119:
      return kSpeedMode;
    case 4120:
      return kToolMode;
    default:
      return 0;
  }
}

}  // namespace

MacroVariables::MacroVariables(const State& state) : state_(state) {
  // NaN means vacant: FANUC's #0, which differs from 0.
  numbers_.fill(std::numeric_limits<double>::quiet_NaN());
}

Lookup MacroVariables::number(int index, double& value) const {
  if (index == 0) {
    return Lookup::no_such_name;
  }
  if (is_kept(index)) {
    value = numbers_[static_cast<std::size_t>(index)];
    if (known_ != nullptr && unknown_[static_cast<std::size_t>(index)]) {
      known_->heard = true;
    }
    return std::isnan(value) ? Lookup::no_such_name : Lookup::found;
  }
  if (index < 1000) {
    return Lookup::no_such_number;
  }
  if (!mode(index, value) && !position(index, value)) {
    return Lookup::not_known_here;
  }
  hear(index, value);
  return Lookup::found;
}

void MacroVariables::hear(int index, double value) const {
  if (known_ == nullptr) {
    return;
  }
  const int axis = index % 20 - 1;  // #5001 …, #5021 …, #5041 …
  const bool is_position = index > 5000;
  const bool known = is_position ? index < 5021 && (known_->axes >> axis & 1U) != 0
                                 : (mode_of(index) & ~known_->modes) == 0;
  if (!known) {
    known_->hear("#" + std::to_string(index), value);
  }
}

// Codes of the blocks before this one.
bool MacroVariables::mode(int index, double& value) const {
  const auto yes = [&](double answer) {
    value = answer;
    return true;
  };
  // A rewriter must know which modes a line depends on.
  asked_.about_mode(mode_of(index));
  switch (index) {
    case 4001:
      // Codes are stored times ten (G38.2); FANUC's groups hold whole ones.
      return state_.plain_motion >= 0 && yes(state_.plain_motion / 10.0);
    case 4002:
      return yes(state_.plane == Plane::xy ? 17.0 : state_.plane == Plane::zx ? 18.0 : 19.0);
    case 4003:
      return yes(state_.incremental ? 91.0 : 90.0);
    case 4005:
      return state_.feed_mode != FeedMode::inverse_time &&
             yes(state_.feed_mode == FeedMode::per_minute ? 94.0 : 95.0);
    case 4006:
      return yes(state_.unit_mm == 1.0 ? 21.0 : 20.0);
    case 4009:
      return yes(state_.motion == g::kFineBore          ? 76.0
                 : state_.motion == g::kBackBoreByShift ? 87.0
                 : is_cycle(state_.motion)              ? state_.motion / 10.0
                                                        : g::kCycleEnd / 10.0);
    case 4010:
      return yes(state_.retract_to_initial ? 98.0 : 99.0);
    case 4014:
      // G54 to G59; #4014 has no value for others.
      return state_.active_offset < 6 && yes(54.0 + static_cast<double>(state_.active_offset));
    case 4109:
      return state_.feed_mode == FeedMode::per_minute &&
             yes(state_.feed_mm_s * 60.0 / state_.feed_unit_mm);
    case 4119:
      return !state_.surface_speed && yes(state_.spindle_speed_rev_s * 60.0);
    case 4120:
      return yes(state_.selected_tool);
    default:
      return false;
  }
}

bool MacroVariables::position(int index, double& value) const {
  constexpr int kBlockEnd = 5001;
  constexpr int kMachine = 5021;
  constexpr int kNose = 5041;
  constexpr int kAnswered = 3;  // X Y Z: the name of the fourth axis is machine data
  for (const int first : {kBlockEnd, kMachine, kNose}) {
    if (index < first || index >= first + kAnswered) {
      continue;
    }
    const auto axis = static_cast<std::size_t>(index - first);
    // In an inch program the unit of machine coordinates is a setting of the control.
    if (first == kMachine && state_.unit_mm != 1.0) {
      return false;
    }
    // 5001 is the programmed position, 5021 the machine position, 5041 that of the spindle nose in
    // work coordinates.
    value = state_.position[axis] + (first == kBlockEnd  ? 0.0
                                     : first == kMachine ? state_.offset[axis]
                                                         : state_.tool_offset[axis]);
    value /= state_.unit_mm;
    asked_.about_position(axis);
    if (first != kBlockEnd) {  // offset and tool length are not the program's
      asked_.about("#" + std::to_string(index));
    }
    return true;
  }
  return false;
}

Lookup MacroVariables::name(std::string_view /*name*/, double& /*value*/) const {
  return Lookup::not_known_here;
}

Lookup MacroVariables::set_number(int index, double value) {
  if (index == 0) {
    return Lookup::read_only;
  }
  if (!is_kept(index)) {
    return index < 1000 ? Lookup::no_such_number : Lookup::read_only;
  }
  // Takes effect once the block has been read to its end, as on the control.
  pending_.push_back({index, value, take_unknown()});
  return Lookup::found;
}

Lookup MacroVariables::set_name(std::string_view /*name*/, double /*value*/) {
  return Lookup::read_only;
}

void MacroVariables::commit() {
  for (const auto& [index, value, unknown] : pending_) {
    numbers_[static_cast<std::size_t>(index)] = value;
    unknown_[static_cast<std::size_t>(index)] = unknown;
  }
  drop();
}

void MacroVariables::list(std::vector<std::pair<std::string, double>>& out) const {
  for (std::size_t i = 0; i < numbers_.size(); ++i) {
    if (!std::isnan(numbers_[i])) {
      out.emplace_back("#" + std::to_string(i), numbers_[i]);
    }
  }
}

void MacroVariables::drop() noexcept {
  pending_.clear();
}

// Least increments of IS-B: a calculated address is rounded to them, as on the control; other
// addresses (F, S, P …) are not.
double MacroVariables::increment(char letter) const {
  constexpr double kMetric = 0.001;
  constexpr double kInch = 0.0001;
  if (std::string_view{"ABC"}.find(letter) != std::string_view::npos) {
    return kMetric;
  }
  return std::string_view{"XYZIJKRQUVW"}.find(letter) == std::string_view::npos ? 0.0
         : state_.unit_mm == 1.0                                                ? kMetric
                                                                                : kInch;
}

}  // namespace steadyrest::nc::interpret
