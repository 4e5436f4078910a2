// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstdint>
#include <string_view>

namespace steadyrest::kernel::machine {

/// The families of controls whose programs are read.
enum class Dialect : std::uint8_t { linuxcnc, fanuc, sinumerik };

/// As machine files and the command line write them, in the order of `Dialect`.
inline constexpr std::array<std::string_view, 3> kDialectNames = {"linuxcnc", "fanuc", "sinumerik"};

}  // namespace steadyrest::kernel::machine
