// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <steadyrest/nc/interpret/decode/dialect_rules.hpp>

namespace steadyrest::nc::interpret {

/// SINUMERIK 840D/828D programs in Siemens' own language (not the ISO dialect).
[[nodiscard]] const DialectRules& sinumerik_rules() noexcept;

}  // namespace steadyrest::nc::interpret
