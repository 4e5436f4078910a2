// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <map>
#include <stdexcept>
#include <string>
#include <variant>

/// Just enough of LinuxCNC's HAL to run one realtime component inside a test tool: pins are plain
/// variables, exported functions are called by hand. For test tools only.
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

  template <class T>
  T* add(const std::string& name) {
    return &std::get<T>(pins_.insert_or_assign(name, Pin(T{})).first->second);
  }
  void add(const std::string& name, const HalFunction& function) { functions_[name] = function; }

  /// Both throw std::out_of_range for a name that the component did not export.
  template <class T>
  [[nodiscard]] T& pin(const std::string& name) {
    return std::get<T>(pins_.at(name));
  }
  [[nodiscard]] HalFunction function(const std::string& name) const { return functions_.at(name); }

 private:
  std::map<std::string, Pin> pins_;  // nodes stay where they are: the component keeps the addresses
  std::map<std::string, HalFunction> functions_;
};

/// The one HAL of this process.
Hal& hal();

}  // namespace steadyrest::test::linuxcnc
