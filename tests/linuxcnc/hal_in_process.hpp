// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <map>
#include <stdexcept>
#include <string>
#include <type_traits>
#include <variant>

/// Just enough of LinuxCNC's HAL to run its realtime components inside a test: pins are plain
/// variables, exported functions are called by hand. For tests only.
namespace steadyrest::test::linuxcnc {

/// A function that the component exported.
struct HalFunction {
  void (*call)(void*, long) = nullptr;
  void* argument = nullptr;
  void operator()(std::int64_t period_ns) const { call(argument, static_cast<long>(period_ns)); }
};

class Hal {
 public:
  using Pin = std::variant<bool, double, std::int32_t>;

  /// `place`: where the component keeps the pin's address.
  template <class T>
  void add(const std::string& name, T** place) {
    *place = &std::get<T>(pins_.insert_or_assign(name, Pin(T{})).first->second);
    place_[name] = place;
  }
  /// A parameter is the component's own variable.
  template <class T>
  void add_parameter(const std::string& name, T* parameter) {
    parameter_[name] = parameter;
  }
  void add(const std::string& name, const HalFunction& function) { functions_[name] = function; }

  /// Both throw std::out_of_range for a name that the component did not export.
  template <class T>
  [[nodiscard]] T& pin(const std::string& name) {
    return std::get<T>(pins_.at(name));
  }
  [[nodiscard]] HalFunction function(const std::string& name) const { return functions_.at(name); }
  /// The pin from now on has the other variable for its own, as after a `net`.
  template <class T>
  void link(const std::string& name, T* variable) {
    *std::get<T**>(place_.at(name)) = variable;
  }
  [[nodiscard]] const Pin* find(const std::string& name) const {
    const auto found = pins_.find(name);
    return found == pins_.end() ? nullptr : &found->second;
  }
  /// A pin that is not linked, or a parameter.
  void set(const std::string& name, double value) {
    const auto put = [&](auto* variable) {
      *variable = static_cast<std::remove_pointer_t<decltype(variable)>>(value);
    };
    if (const auto found = parameter_.find(name); found != parameter_.end()) {
      std::visit(put, found->second);
    } else {
      std::visit([&](auto& variable) { put(&variable); }, pins_.at(name));
    }
  }

 private:
  std::map<std::string, Pin> pins_;  // nodes stay where they are: the component keeps the addresses
  std::map<std::string, std::variant<bool**, double**, std::int32_t**>> place_;
  std::map<std::string, std::variant<bool*, double*, std::int32_t*>> parameter_;
  std::map<std::string, HalFunction> functions_;
};

/// The one HAL of this process.
Hal& hal();

}  // namespace steadyrest::test::linuxcnc
