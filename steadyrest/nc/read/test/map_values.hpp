// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <functional>
#include <map>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include <steadyrest/nc/read/text/typed_values.hpp>

namespace steadyrest::nc::read::test {

/// Variables in two maps, for a test to fill and to look into. #0 … #999 exist; those that are not
/// in the map were never set.
class MapValues final : public TypedValues {
 public:
  explicit MapValues(std::map<int, double> set_numbers = {},
                     std::map<std::string, double, std::less<>> set_names = {})
      : numbers(std::move(set_numbers)), names(std::move(set_names)) {}

  std::map<int, double> numbers;
  std::map<std::string, double, std::less<>> names;
  std::map<char, double> increments;

  [[nodiscard]] Lookup number(int index, double& value) const override {
    const auto found = numbers.find(index);
    value = found == numbers.end() ? 0.0 : found->second;
    return found != numbers.end()       ? Lookup::found
           : index >= 0 && index < 1000 ? Lookup::no_such_name
                                        : Lookup::no_such_number;
  }
  [[nodiscard]] Lookup name(std::string_view name, double& value) const override {
    const auto found = names.find(name);
    value = found == names.end() ? 0.0 : found->second;
    return found == names.end() ? Lookup::no_such_name : Lookup::found;
  }
  Lookup set_number(int index, double value) override {
    pending_.emplace_back(index, value);
    return Lookup::found;
  }
  Lookup set_name(std::string_view name, double value) override {
    names.insert_or_assign(std::string{name}, value);
    return Lookup::found;
  }
  void commit() override {
    for (const auto& [index, value] : pending_) {
      numbers[index] = value;
    }
    drop();
  }
  void drop() noexcept override { pending_.clear(); }
  [[nodiscard]] double increment(char letter) const override {
    const auto found = increments.find(letter);
    return found == increments.end() ? 0.0 : found->second;
  }
  bool define(std::string_view name, ValueType /*type*/, double value) override {
    return names.emplace(name, value).second;
  }
  bool define_argument(std::string_view name, ValueType type, std::size_t /*place*/,
                       double otherwise) override {
    return define(name, type, otherwise);
  }

 private:
  std::vector<std::pair<int, double>> pending_;
};

}  // namespace steadyrest::nc::read::test
