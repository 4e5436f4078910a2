// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <string>
#include <string_view>

#include <steadyrest/nc/read/text/values.hpp>

namespace steadyrest::nc::read {

enum class ValueType : std::uint8_t { real, integer, boolean, character };

/// Values of `sinumerik`: R-parameters by number, variables by name (in lower case) and type. A
/// value is converted to its variable's type: INT and CHAR round, BOOL is true unless zero. An
/// element of an array is a variable with its indices in the name, `a[2,0]`. STRING variables are
/// apart.
class TypedValues : public Values {
 public:
  /// DEF: false when the name is already in use here.
  virtual bool define(std::string_view name, ValueType type, double value) = 0;
  /// PROC: the parameter at this place of the call, or `otherwise` where the call leaves it out.
  virtual bool define_argument(std::string_view name, ValueType type, std::size_t place,
                               double otherwise) = 0;
  /// The values of a call are read; the one at a place is a variable of the caller.
  virtual void begin_call() {}
  virtual void pass(std::size_t /*place*/, std::string_view /*variable*/) {}
  /// PROC with VAR: the parameter is the caller's variable. False where the call has none of the
  /// type.
  virtual bool define_reference(std::string_view /*name*/, ValueType /*type*/,
                                std::size_t /*place*/) {
    return false;
  }

  /// DEF STRING; its content, null for another name; an assignment, which acts with the line's.
  virtual bool define_text(std::string_view /*name*/, std::string_view /*value*/) { return false; }
  [[nodiscard]] virtual const std::string* text(std::string_view /*name*/) const { return nullptr; }
  virtual Lookup set_text(std::string_view /*name*/, std::string_view /*value*/) {
    return Lookup::no_such_name;
  }
  /// A system variable, `$P_EP` with axis `X`; in capitals, axis 0 where it has none.
  [[nodiscard]] virtual Lookup system(std::string_view /*name*/, char /*axis*/,
                                      double& /*value*/) const {
    return Lookup::not_known_here;
  }
};

}  // namespace steadyrest::nc::read
