// SPDX-License-Identifier: Apache-2.0
#include <steadyrest/nc/read/text/dialect.hpp>

namespace steadyrest::nc::read {

std::optional<Dialect> dialect_from_name(std::string_view name) noexcept {
  if (name == "linuxcnc") {
    return Dialect::linuxcnc;
  }
  if (name == "fanuc") {
    return Dialect::fanuc;
  }
  if (name == "sinumerik") {
    return Dialect::sinumerik;
  }
  return std::nullopt;
}

std::string_view name(Dialect dialect) noexcept {
  return dialect == Dialect::linuxcnc ? "linuxcnc"
         : dialect == Dialect::fanuc  ? "fanuc"
                                      : "sinumerik";
}

}  // namespace steadyrest::nc::read
