// SPDX-License-Identifier: Apache-2.0
#include <cstddef>

#include <steadyrest/nc/read/text/dialect.hpp>

namespace steadyrest::nc::read {

using kernel::machine::kDialectNames;

// Names of the command line and of the machine file; their order is that of the enumeration.
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
