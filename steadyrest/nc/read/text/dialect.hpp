// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <optional>
#include <string_view>

namespace steadyrest::nc::read {

/// The families of controls whose programs are read.
enum class Dialect : std::uint8_t { linuxcnc, fanuc, sinumerik };

/// `linuxcnc`, `fanuc`, `sinumerik`; nothing for any other name.
[[nodiscard]] std::optional<Dialect> dialect_from_name(std::string_view name) noexcept;
[[nodiscard]] std::string_view name(Dialect dialect) noexcept;

}  // namespace steadyrest::nc::read
