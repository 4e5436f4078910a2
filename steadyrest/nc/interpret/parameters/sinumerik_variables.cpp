// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

#include <steadyrest/nc/interpret/parameters/sinumerik_variables.hpp>

namespace steadyrest::nc::interpret {
namespace {

using read::Lookup;
using read::ValueType;

constexpr int kParameters = 1000;

// DEF INT and CHAR round to the nearest; BOOL is 1 for anything but 0.
double converted(ValueType type, double value) noexcept {
  return type == ValueType::real      ? value
         : type != ValueType::boolean ? std::round(value)
         : value != 0.0               ? 1.0
                                      : 0.0;
}

}  // namespace

// NaN means an R-parameter that this program has not set.
SinumerikVariables::SinumerikVariables()
    : numbers_(kParameters, std::numeric_limits<double>::quiet_NaN()),
      unknown_(kParameters),
      frames_(1) {}

void SinumerikVariables::hear(bool unknown) const noexcept {
  if (unknown && known_ != nullptr) {
    known_->heard = true;
  }
}

void SinumerikVariables::list(std::vector<std::pair<std::string, double>>& out) const {
  for (std::size_t i = 0; i < numbers_.size(); ++i) {
    if (!std::isnan(numbers_[i])) {
      out.emplace_back("R" + std::to_string(i), numbers_[i]);
    }
  }
}

Lookup SinumerikVariables::number(int index, double& value) const {
  if (index < 0 || index >= kParameters) {
    return Lookup::no_such_number;
  }
  // Whether a read within the block sees the new or the old value is not certain: refused rather
  // than guessed.
  if (std::ranges::any_of(pending_numbers_, [&](const auto& one) { return one.key == index; })) {
    return Lookup::assigned_in_block;
  }
  value = numbers_[static_cast<std::size_t>(index)];
  hear(unknown_[static_cast<std::size_t>(index)]);
  return std::isnan(value) ? Lookup::no_such_name : Lookup::found;
}

Lookup SinumerikVariables::name(std::string_view name, double& value) const {
  // Variables belong to the program that defines them; a caller's are not visible.
  const auto found = frames_.back().variables.find(name);
  if (found == frames_.back().variables.end()) {
    return Lookup::no_such_name;
  }
  if (std::ranges::any_of(pending_names_, [&](const auto& one) { return one.key == name; })) {
    return Lookup::assigned_in_block;
  }
  value = found->second.value;
  hear(found->second.unknown);
  return Lookup::found;
}

// Assignments wait until the block is accepted: a refused or deleted block sets nothing.
Lookup SinumerikVariables::set_number(int index, double value) {
  if (index < 0 || index >= kParameters) {
    return Lookup::no_such_number;
  }
  pending_numbers_.push_back({.key = index, .value = value, .unknown = take_unknown()});
  return Lookup::found;
}

Lookup SinumerikVariables::set_name(std::string_view name, double value) {
  if (!frames_.back().variables.contains(name)) {
    return Lookup::no_such_name;
  }
  pending_names_.push_back({.key = std::string{name}, .value = value, .unknown = take_unknown()});
  return Lookup::found;
}

// What is set in doubt may have another value.
void SinumerikVariables::commit() {
  for (const auto& [index, value, unknown] : pending_numbers_) {
    numbers_[static_cast<std::size_t>(index)] = value;
    unknown_[static_cast<std::size_t>(index)] = unknown || in_doubt();
  }
  for (const auto& [name, value, unknown] : pending_names_) {
    Variable& variable = frames_.back().variables.find(name)->second;
    variable.value = converted(variable.type, value);
    variable.unknown = unknown || in_doubt();
  }
  for (auto& [name, value] : pending_texts_) {
    frames_.back().texts.find(name)->second = std::move(value);
  }
  drop();
}

void SinumerikVariables::drop() noexcept {
  pending_numbers_.clear();
  pending_names_.clear();
  pending_texts_.clear();
}

bool SinumerikVariables::define(std::string_view name, ValueType type, double value) {
  Frame& frame = frames_.back();
  return frame.variables.size() < kMostVariables && !frame.texts.contains(name) &&
         frame.variables
             .try_emplace(std::string{name}, Variable{.type = type,
                                                      .value = converted(type, value),
                                                      .unknown = take_unknown() || in_doubt()})
             .second;
}

bool SinumerikVariables::define_text(std::string_view name, std::string_view value) {
  Frame& frame = frames_.back();
  return frame.texts.size() < kMostVariables && !frame.variables.contains(name) &&
         frame.texts.try_emplace(std::string{name}, value).second;
}

const std::string* SinumerikVariables::text(std::string_view name) const {
  const auto found = frames_.back().texts.find(name);
  return found == frames_.back().texts.end() ? nullptr : &found->second;
}

Lookup SinumerikVariables::set_text(std::string_view name, std::string_view value) {
  if (text(name) == nullptr) {
    return Lookup::no_such_name;
  }
  pending_texts_.emplace_back(name, value);
  return Lookup::found;
}

void SinumerikVariables::lose_all() {
  for (std::size_t i = 0; i < numbers_.size(); ++i) {
    unknown_[i] = !std::isnan(numbers_[i]);
  }
  for (Frame& frame : frames_) {
    for (auto& [name, variable] : frame.variables) {
      variable.unknown = true;
    }
  }
}

bool SinumerikVariables::define_argument(std::string_view name, ValueType type, std::size_t place,
                                         double otherwise) {
  Frame& frame = frames_.back();
  // PROC names the values of the call by place; omitted ones take their default.
  const bool given = place < frame.call.count && (frame.call.given >> place & 1U) != 0;
  frame.taken = std::max(frame.taken, place + 1);
  hear(given && (frame.call.unknown >> place & 1U) != 0);
  return define(name, type, given ? frame.call.values[place] : otherwise);
}

void SinumerikVariables::pass(std::size_t place, std::string_view variable) {
  passed_.insert_or_assign(place, variable);
}

// Set at the end: the subprogram cannot see the caller's variable under its own name.
bool SinumerikVariables::define_reference(std::string_view name, ValueType type,
                                          std::size_t place) {
  Frame& frame = frames_.back();
  const auto passed = frame.passed.find(place);
  if (frames_.size() < 2 || passed == frame.passed.end()) {
    return false;
  }
  const auto& callers = frames_[frames_.size() - 2].variables;
  const auto variable = callers.find(passed->second);
  if (variable == callers.end() || variable->second.type != type) {
    return false;
  }
  frame.taken = std::max(frame.taken, place + 1);
  frame.references.emplace_back(name, passed->second);
  hear(variable->second.unknown);
  return define(name, type, variable->second.value);
}

void SinumerikVariables::give_back() {
  Frame& frame = frames_.back();
  for (const auto& [own, callers] : frame.references) {
    frames_[frames_.size() - 2].variables.find(callers)->second = frame.variables.find(own)->second;
  }
  frame.references.clear();
}

void SinumerikVariables::enter(const read::Flow& call) {
  Frame& frame = frames_.emplace_back();
  frame.call = call;
  frame.passed = std::exchange(passed_, {});
}

// The next repeat of NAME P3: variables start over, the call's values stay.
void SinumerikVariables::restart() {
  give_back();
  frames_.back().variables.clear();
  frames_.back().texts.clear();
  frames_.back().taken = 0;
}

void SinumerikVariables::leave() {
  give_back();
  frames_.pop_back();
}

}  // namespace steadyrest::nc::interpret
