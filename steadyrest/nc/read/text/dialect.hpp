// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <string_view>

#include <steadyrest/kernel/machine/dialect.hpp>

namespace steadyrest::nc::read {

using kernel::machine::Dialect;

/// Nothing for a name that is not in kDialectNames.
[[nodiscard]] std::optional<Dialect> dialect_from_name(std::string_view name) noexcept;
[[nodiscard]] std::string_view name(Dialect dialect) noexcept;

}  // namespace steadyrest::nc::read
