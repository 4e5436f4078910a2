// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <cmath>

#include <steadyrest/nc/interpret/parameters/parameter_answers.hpp>
#include <steadyrest/nc/interpret/parameters/parameters.hpp>
#include <steadyrest/nc/interpret/state/frame.hpp>
#include <steadyrest/nc/interpret/state/step.hpp>

namespace steadyrest::nc::interpret {
namespace {

using read::Lookup;

// Three stores: numbers, global names, and the local names of each call. #5161 … and the predefined
// names have no store: they show the state itself, so they never lag behind a G10 or a move. A
// line's assignments wait until the whole line has been read.

constexpr int kProbe = 5061;       // … 5069; 5070 tells whether it touched
constexpr int kHome = 5161;        // … 5169
constexpr int kSecondHome = 5181;  // … 5189
constexpr int kG92InForce = 5210;
constexpr int kG92 = 5211;  // … 5219
constexpr int kActiveOffset = 5220;
constexpr int kOffsets = 5221;  // nine of twenty numbers each; the tenth is the rotation
constexpr int kOffsetStride = 20;
constexpr int kTool = 5400;
constexpr int kToolOffset = 5401;    // … 5409
constexpr int kToolDiameter = 5410;  // then front angle, back angle, orientation
constexpr int kPosition = 5420;      // … 5428
constexpr int kAxes = 9;
constexpr int kDebugging = 5599;     // whether (DEBUG,…) shows: 1 at the start
constexpr int kChangerFault = 5600;  // and 5601: the tool changer's, read-only

constexpr bool within(int index, int first) noexcept {
  return index >= first && index < first + kAxes;
}
constexpr bool reads_only(int index) noexcept {
  return (index >= kTool && index < kToolDiameter + 4) || within(index, kPosition) ||
         index == kG92InForce || index == kActiveOffset;
}

// Values that only the running machine knows.
bool of_machine(std::string_view name) noexcept {
  return name.starts_with("_hal[") || name.starts_with("_ini[") || name == "_current_pocket" ||
         name == "_selected_pocket" || name == "_metric_machine";
}

}  // namespace

Parameters::Parameters()
    : numbers_(static_cast<std::size_t>(kNumbers), 0.0), set_(numbers_.size(), false) {
  numbers_[kDebugging] = 1.0;
  set_[kDebugging] = true;
}

void Parameters::keep(std::span<const std::pair<int, double>> numbers) {
  for (const auto& [index, value] : numbers) {
    // Probe results (#5061 …) are not kept, and from #5161 on numbers show the state.
    if (index >= 1 && index < kProbe) {
      numbers_[static_cast<std::size_t>(index)] = value;
      set_[static_cast<std::size_t>(index)] = true;
    }
  }
}

void Parameters::list(std::vector<std::pair<std::string, double>>& out) const {
  for (std::size_t i = 0; i < numbers_.size(); ++i) {
    if (set_[i]) {
      out.emplace_back("#" + std::to_string(i), numbers_[i]);
    }
  }
  const std::size_t first = out.size();
  for (const auto& [name, value] : globals_) {
    out.emplace_back("#<" + name + ">", value);
  }
  std::sort(out.begin() + static_cast<std::ptrdiff_t>(first), out.end());
}

// For the numbers that of_state() answers.
void Parameters::ask(int index) const {
  if (within(index, kPosition)) {
    asked_.about_position(static_cast<std::size_t>(index - kPosition));
  } else if (index == kActiveOffset) {
    asked_.about_mode(mode(GGroup::work_offset));
  } else if (index == kTool) {
    asked_.about_mode(kToolMode);
  } else if (index > kTool && index < kToolDiameter + 4) {
    asked_.about_mode(kToolMode);
    if (!config_->tools) {
      asked_.about("#" + std::to_string(index));
    }
  } else if (!config_->start_known) {
    asked_.about("#" + std::to_string(index));
  }
}

void Parameters::ask(std::string_view name) const {
  constexpr std::string_view kLetters = "xyzabcuvw";
  const std::size_t axis = kLetters.find(name.back());
  if (name.size() == 2 && axis != std::string_view::npos) {
    asked_.about_position(axis);
  } else if (name.starts_with("_abs_") && name.size() == 6 && axis != std::string_view::npos) {
    asked_.about_position(axis);
    if (!config_->start_known) {
      asked_.about("#<" + std::string{name} + ">");
    }
  } else if (const Answer* const answer = answer_of(name); answer != nullptr && answer->mode != 0) {
    asked_.about_mode(answer->mode);
  }
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
    return true;
  }
  if (name == "_call_level") {
    value = static_cast<double>(calls_.size());
    return true;
  }
  if (name == "_task") {
    value = config_->on_control ? 1.0 : 0.0;
    return true;
  }
  const Answer* const answer = answer_of(name);
  if (answer != nullptr) {
    value = answer->value(*state_);
  }
  return answer != nullptr;
}

// Numbers that a program has not set read as 0 in LinuxCNC; they count as read from the control,
// which may hold another value.
Lookup Parameters::number(int index, double& value) const {
  if (index < 1 || index >= kNumbers) {
    return Lookup::no_such_number;
  }
  if (within(index, kPosition) && state_->cutter_side != 0) {
    return Lookup::not_while_compensating;
  }
  // Below #5161 no number shows the state, so the common numbers skip the look-up.
  if (index >= kHome && of_state(index, value)) {
    ask(index);
    return Lookup::found;
  }
  if (config_->on_control && !set_[static_cast<std::size_t>(index)]) {
    return Lookup::kept_by_control;
  }
  value = numbers_[static_cast<std::size_t>(index)];
  // The value may come from the control's past: noted, since a rewriter must not rely on it.
  if (!set_[static_cast<std::size_t>(index)]) {
    asked_.about("#" + std::to_string(index));
  }
  return Lookup::found;
}

const Parameters::Names& Parameters::local_names() const noexcept {
  // M98 shares the names of its caller; a call by O-word has its own.
  const auto own =
      std::find_if(calls_.rbegin(), calls_.rend(), [](const Call& call) { return !call.shared; });
  return own == calls_.rend() ? main_names_ : own->names;
}

Parameters::Names& Parameters::local_names() noexcept {
  return const_cast<Names&>(std::as_const(*this).local_names());
}

Lookup Parameters::name(std::string_view name, double& value) const {
  if (name.front() != '_') {
    const Names& names = local_names();
    const auto found = names.find(name);
    if (found == names.end()) {
      return Lookup::no_such_name;
    }
    value = found->second;
    return Lookup::found;
  }
  if (of_state(name, value)) {
    ask(name);
    return Lookup::found;
  }
  const auto found = globals_.find(name);
  if (found != globals_.end()) {
    value = found->second;
    return Lookup::found;
  }
  if (config_->on_control) {
    return Lookup::kept_by_control;
  }
  asked_.about("#<" + std::string{name} + ">");  // EXISTS
  return of_machine(name) ? Lookup::not_known_here : Lookup::no_such_name;
}

// Takes effect once the line has been read: `#1=2 G0 X#1` still uses the old #1.
Lookup Parameters::set_number(int index, double value) {
  if (index < 1 || index >= kNumbers) {
    return Lookup::no_such_number;
  }
  if (reads_only(index)) {
    return Lookup::read_only;
  }
  pending_numbers_.emplace_back(index, value);
  return Lookup::found;
}

// Global names begin with _; those that show the state or the machine cannot be written.
Lookup Parameters::set_name(std::string_view name, double value) {
  double ignored = 0.0;
  if (name.front() == '_' &&
      (of_state(name, ignored) || of_machine(name) || name.find('[') != std::string_view::npos)) {
    return Lookup::read_only;
  }
  pending_names_.emplace_back(name, value);
  return Lookup::found;
}

void Parameters::assign(int index, double value) {
  bool rotary = false;
  if (double* const place = index >= kHome ? stored(index, rotary) : nullptr; place != nullptr) {
    // Only the stored number changes. LinuxCNC acts on it when the system is selected again, so the
    // values in force stay.
    *place = rotary ? value : value * config_->data_unit_mm;
    if (index >= kOffsets) {
      asked_.about_offset(std::uint32_t{1}
                          << static_cast<unsigned>((index - kOffsets) / kOffsetStride));
    } else if (within(index, kG92)) {
      asked_.about_offset(Asked::kShift);
    }
    return;
  }
  if (index < kChangerFault) {
    numbers_[static_cast<std::size_t>(index)] = value;
    set_[static_cast<std::size_t>(index)] = true;
  }
}

void Parameters::commit() {
  for (const auto& [index, value] : pending_numbers_) {
    assign(index, value);
  }
  for (const auto& [name, value] : pending_names_) {
    (name.front() == '_' ? globals_ : local_names())[name] = value;
  }
  drop();
}

void Parameters::drop() noexcept {
  pending_numbers_.clear();
  pending_names_.clear();
}

void Parameters::record_probe(const Axes& end) {
  // LinuxCNC would record where the probe touched. Here it is assumed to touch at the end, but the
  // numbers count as unset, so that their use is reported.
  for (std::size_t axis = 0; axis < kAxes; ++axis) {
    const auto number = static_cast<std::size_t>(kProbe) + axis;
    numbers_[number] = end[axis] / (is_rotary(axis) ? 1.0 : state_->unit_mm);
    set_[number] = false;  // where it touches is unknown
  }
  set_[kProbe + kAxes] = false;
  numbers_[kProbe + kAxes] = 0.0;
}

void Parameters::enter(std::span<const double> arguments) {
  Call call;
  std::copy_n(numbers_.begin() + 1, kLocals, call.saved.begin());
  std::copy_n(set_.begin() + 1, kLocals, call.saved_set.begin());
  // A missing argument is 0, and counts as set.
  std::fill_n(numbers_.begin() + 1, kLocals, 0.0);
  std::fill_n(set_.begin() + 1, kLocals, true);
  std::ranges::copy(arguments, numbers_.begin() + 1);
  calls_.push_back(std::move(call));
}

void Parameters::enter_shared() {
  calls_.emplace_back().shared = true;
}

// LinuxCNC restores the caller's #1 to #30; a returned value shows in #<_value>.
void Parameters::leave(const double* returned) {
  if (!calls_.back().shared) {
    std::ranges::copy(calls_.back().saved, numbers_.begin() + 1);
    std::copy_n(calls_.back().saved_set.begin(), kLocals, set_.begin() + 1);
  }
  calls_.pop_back();
  record_value(returned);
}

// endsub and return without a value leave 0, and #<_value_returned> tells so.
void Parameters::record_value(const double* returned) noexcept {
  value_ = returned != nullptr ? *returned : 0.0;
  value_returned_ = returned != nullptr ? 1.0 : 0.0;
}

}  // namespace steadyrest::nc::interpret
