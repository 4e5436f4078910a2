// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <steadyrest/nc/interpret/decode/dialect_rules.hpp>

namespace steadyrest::nc::interpret {

/// Programs of LinuxCNC 2.9.
[[nodiscard]] const DialectRules& linuxcnc_rules() noexcept;

}  // namespace steadyrest::nc::interpret
