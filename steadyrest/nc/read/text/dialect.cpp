// SPDX-License-Identifier: Apache-2.0
#include <cstddef>

#include <steadyrest/nc/read/text/dialect.hpp>

namespace steadyrest::nc::read {

using kernel::machine::kDialectNames;

// Names used on the command line and in the machine file, in the enumeration's order.
std::optional<Dialect> dialect_from_name(std::string_view name) noexcept {
  for (std::size_t i = 0; i < kDialectNames.size(); ++i) {
    if (kDialectNames[i] == name) {
      return static_cast<Dialect>(i);
    }
  }
  return std::nullopt;
}

std::string_view name(Dialect dialect) noexcept {
  return kernel::machine::name_of(dialect);
}

}  // namespace steadyrest::nc::read
