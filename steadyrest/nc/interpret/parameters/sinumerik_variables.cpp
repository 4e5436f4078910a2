// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <cmath>
#include <limits>

#include <steadyrest/nc/interpret/parameters/sinumerik_variables.hpp>
#include <steadyrest/nc/read/sinumerik/sinumerik_words.hpp>

namespace steadyrest::nc::interpret {
namespace {

using read::Lookup;
using read::ValueType;

constexpr int kParameters = 1000;

// DEF INT rounds to the nearest; BOOL is 1 for anything but 0.
double converted(ValueType type, double value) noexcept {
  return type == ValueType::real      ? value
         : type == ValueType::integer ? std::round(value)
         : value != 0.0               ? 1.0
                                      : 0.0;
}

}  // namespace

// NaN means an R-parameter that this program has not set.
SinumerikVariables::SinumerikVariables()
    : numbers_(kParameters, std::numeric_limits<double>::quiet_NaN()), frames_(1) {}

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
  if (std::ranges::any_of(pending_numbers_, [&](const auto& one) { return one.first == index; })) {
    return Lookup::assigned_in_block;
  }
  value = numbers_[static_cast<std::size_t>(index)];
  return std::isnan(value) ? Lookup::no_such_name : Lookup::found;
}

Lookup SinumerikVariables::name(std::string_view name, double& value) const {
  // Variables belong to the program that defines them; a caller's are not visible.
  const auto found = frames_.back().variables.find(name);
  if (found == frames_.back().variables.end()) {
    return read::predefined(name, value) ? Lookup::found : Lookup::no_such_name;
  }
  if (std::ranges::any_of(pending_names_, [&](const auto& one) { return one.first == name; })) {
    return Lookup::assigned_in_block;
  }
  value = found->second.value;
  return Lookup::found;
}

// Assignments wait until the block is accepted: a refused or deleted block sets nothing.
Lookup SinumerikVariables::set_number(int index, double value) {
  if (index < 0 || index >= kParameters) {
    return Lookup::no_such_number;
  }
  pending_numbers_.emplace_back(index, value);
  return Lookup::found;
}

Lookup SinumerikVariables::set_name(std::string_view name, double value) {
  if (!frames_.back().variables.contains(name)) {
    return Lookup::no_such_name;
  }
  pending_names_.emplace_back(name, value);
  return Lookup::found;
}

void SinumerikVariables::commit() {
  for (const auto& [index, value] : pending_numbers_) {
    numbers_[static_cast<std::size_t>(index)] = value;
  }
  for (const auto& [name, value] : pending_names_) {
    Variable& variable = frames_.back().variables.find(name)->second;
    variable.value = converted(variable.type, value);
  }
  drop();
}

void SinumerikVariables::drop() noexcept {
  pending_numbers_.clear();
  pending_names_.clear();
}

bool SinumerikVariables::define(std::string_view name, ValueType type, double value) {
  return frames_.back()
      .variables
      .try_emplace(std::string{name}, Variable{.type = type, .value = converted(type, value)})
      .second;
}

bool SinumerikVariables::define_argument(std::string_view name, ValueType type, std::size_t place,
                                         double otherwise) {
  Frame& frame = frames_.back();
  // PROC names the values of the call by place; omitted ones take their default.
  const bool given = place < frame.call.count && (frame.call.given >> place & 1U) != 0;
  frame.taken = std::max(frame.taken, place + 1);
  return define(name, type, given ? frame.call.values[place] : otherwise);
}

void SinumerikVariables::enter(const read::Flow& call) {
  frames_.emplace_back().call = call;
}

// The next repeat of NAME P3: variables start over, the call's values stay.
void SinumerikVariables::restart() {
  frames_.back().variables.clear();
  frames_.back().taken = 0;
}

void SinumerikVariables::leave() {
  frames_.pop_back();
}

}  // namespace steadyrest::nc::interpret
