// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <string_view>

#include <steadyrest/nc/read/text/values.hpp>

namespace steadyrest::nc::read {

enum class ValueType : std::uint8_t { real, integer, boolean };

/// Values of `sinumerik`: R-parameters by number, variables by name (in lower case) and type. A
/// value is converted to its variable's type: INT rounds, BOOL is true unless zero.
class TypedValues : public Values {
 public:
  /// DEF: false when the name is already in use here.
  virtual bool define(std::string_view name, ValueType type, double value) = 0;
  /// PROC: the parameter at this place of the call, or `otherwise` where the call leaves it out.
  virtual bool define_argument(std::string_view name, ValueType type, std::size_t place,
                               double otherwise) = 0;
};

}  // namespace steadyrest::nc::read
