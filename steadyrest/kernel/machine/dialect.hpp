// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <string_view>

namespace steadyrest::kernel::machine {

/// The families of controls whose programs are read; consecutive from 0.
enum class Dialect : std::uint8_t { linuxcnc, fanuc, sinumerik, haas, grbl, mach3 };

/// As machine files and the command line write it; the names are given only here. A switch, so that
/// the compiler names an enumerator that is forgotten. Empty beyond the last one.
[[nodiscard]] constexpr std::string_view name_of(Dialect dialect) noexcept {
  switch (dialect) {
    case Dialect::linuxcnc:
      return "linuxcnc";
    case Dialect::fanuc:
      return "fanuc";
    case Dialect::sinumerik:
      return "sinumerik";
    case Dialect::haas:
      return "haas";
    case Dialect::grbl:
      return "grbl";
    case Dialect::mach3:
      return "mach3";
  }
  return {};
}

inline constexpr std::size_t kDialectCount = [] {
  std::size_t count = 0;
  while (!name_of(static_cast<Dialect>(count)).empty()) {
    ++count;
  }
  return count;
}();

/// All names, in the order of `Dialect`.
inline constexpr std::array<std::string_view, kDialectCount> kDialectNames = [] {
  std::array<std::string_view, kDialectCount> names;
  for (std::size_t i = 0; i < names.size(); ++i) {
    names[i] = name_of(static_cast<Dialect>(i));
  }
  return names;
}();

}  // namespace steadyrest::kernel::machine
