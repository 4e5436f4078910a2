// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <cmath>

#include <steadyrest/nc/interpret/parameters/parameter_numbers.hpp>
#include <steadyrest/nc/interpret/parameters/parameters.hpp>
#include <steadyrest/nc/interpret/state/step.hpp>

namespace steadyrest::nc::interpret {

using read::Lookup;

// Three stores: numbers, global names, and the local names of each call. #5161 … and the predefined
// names have no store: they show the state itself, so they never lag behind a G10 or a move. A
// line's assignments wait until the whole line has been read.

Parameters::Parameters()
    : numbers_(static_cast<std::size_t>(kNumbers), 0.0),
      set_(numbers_.size(), false),
      unknown_(numbers_.size(), false) {
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
  for (const auto& [name, named] : globals_) {
    if (named.set) {
      out.emplace_back("#<" + name + ">", named.value);
    }
  }
  std::sort(out.begin() + static_cast<std::ptrdiff_t>(first), out.end());
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
    ask(index, value);
    return Lookup::found;
  }
  if (config_->on_control && !set_[static_cast<std::size_t>(index)]) {
    return Lookup::kept_by_control;
  }
  value = numbers_[static_cast<std::size_t>(index)];
  // The value may come from the control's past: noted, since a rewriter must not rely on it.
  if (!set_[static_cast<std::size_t>(index)]) {
    asked_.about("#" + std::to_string(index));
    hear("#" + std::to_string(index), value);
  } else if (known_ != nullptr && unknown_[static_cast<std::size_t>(index)]) {
    known_->heard = true;
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

Lookup Parameters::read_named(const Named& named, double& value) const {
  if (known_ != nullptr && named.unknown) {
    known_->heard = true;
  }
  value = named.value;
  return named.set ? Lookup::found : Lookup::no_such_name;
}

void Parameters::hear(std::string name, double value) const {
  if (known_ != nullptr) {
    known_->hear(std::move(name), value);
  }
}

Lookup Parameters::name(std::string_view name, double& value) const {
  if (name.front() != '_') {
    const Names& names = local_names();
    const auto found = names.find(name);
    return found == names.end() ? Lookup::no_such_name : read_named(found->second, value);
  }
  if (of_state(name, value)) {
    ask(name, value);
    return Lookup::found;
  }
  const auto found = globals_.find(name);
  if (found != globals_.end() && found->second.set) {
    return read_named(found->second, value);
  }
  if (config_->on_control) {
    return Lookup::kept_by_control;
  }
  asked_.about("#<" + std::string{name} + ">");  // EXISTS
  hear("EXISTS[#<" + std::string{name} + ">]", 0.0);
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
  pending_numbers_.push_back({index, value, take_unknown() || in_doubt()});
  return Lookup::found;
}

// Global names begin with _; those that show the state or the machine cannot be written.
Lookup Parameters::set_name(std::string_view name, double value) {
  double ignored = 0.0;
  if (name.front() == '_' &&
      (of_state(name, ignored) || of_machine(name) || name.find('[') != std::string_view::npos)) {
    return Lookup::read_only;
  }
  pending_names_.push_back({std::string{name}, value, take_unknown() || in_doubt()});
  return Lookup::found;
}

void Parameters::assign(int index, double value, bool unknown) {
  bool rotary = false;
  if (double* const place = index >= kHome ? stored(index, rotary) : nullptr; place != nullptr) {
    // Only the stored number changes. LinuxCNC acts on it when the system is selected again, so the
    // values in force stay.
    *place = rotary ? value : value * config_->data_unit_mm;
    if (unknown && known_ != nullptr) {
      known_->offsets = false;
    }
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
    unknown_[static_cast<std::size_t>(index)] = unknown;
  }
}

void Parameters::commit() {
  for (const auto& [index, value, unknown] : pending_numbers_) {
    assign(index, value, unknown);
  }
  for (const auto& [name, value, unknown] : pending_names_) {
    (name.front() == '_' ? globals_ : local_names())[name] = {.value = value, .unknown = unknown};
  }
  if (sets_any_) {
    lose_all();
  }
  drop();
}

void Parameters::drop() noexcept {
  pending_numbers_.clear();
  pending_names_.clear();
  sets_any_ = false;
}

void Parameters::lose(int index) {
  if (index >= kHome && known_ != nullptr) {
    known_->offsets = false;
  }
  if (index >= 1 && index < kNumbers) {
    unknown_[static_cast<std::size_t>(index)] = true;
  }
}

void Parameters::lose(std::string_view name) {
  Names& names = name.front() == '_' ? globals_ : local_names();
  const auto found = names.find(name);
  if (found != names.end()) {
    found->second.unknown = true;
  } else {
    names[std::string{name}] = {.value = 0.0, .unknown = true, .set = false};
  }
}

void Parameters::lose_all() {
  std::fill(unknown_.begin(), unknown_.end(), true);
  for (Names* names : {&globals_, &local_names()}) {
    for (auto& [name, named] : *names) {
      named.unknown = true;
    }
  }
  value_unknown_ = true;
  if (known_ != nullptr) {
    known_->offsets = false;
  }
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

void Parameters::lose_input() {
  lose(kInput);
}

void Parameters::record_input() {
  set_[kInput] = false;
}

void Parameters::enter(std::span<const double> arguments, std::uint32_t unknown) {
  Call call;
  std::copy_n(unknown_.begin() + 1, kLocals, call.saved_unknown.begin());
  for (std::size_t i = 0; i < kLocals; ++i) {
    unknown_[i + 1] = (unknown >> i & 1U) != 0;
  }
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
void Parameters::leave(const double* returned, bool unknown) {
  if (!calls_.back().shared) {
    std::copy_n(calls_.back().saved_unknown.begin(), kLocals, unknown_.begin() + 1);
    std::ranges::copy(calls_.back().saved, numbers_.begin() + 1);
    std::copy_n(calls_.back().saved_set.begin(), kLocals, set_.begin() + 1);
  }
  calls_.pop_back();
  record_value(returned, unknown);
}

// endsub and return without a value leave 0, and #<_value_returned> tells so.
void Parameters::record_value(const double* returned, bool unknown) noexcept {
  value_unknown_ = unknown || in_doubt();
  value_ = returned != nullptr ? *returned : 0.0;
  value_returned_ = returned != nullptr ? 1.0 : 0.0;
}

}  // namespace steadyrest::nc::interpret
