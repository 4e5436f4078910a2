// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <steadyrest/nc/interpret/decode/dialect_rules.hpp>

namespace steadyrest::nc::interpret {

/// FANUC-style milling programs: G code system of the machining-centre controls, also Mazak EIA.
/// Codes that mean something else on lathes are refused, not guessed.
[[nodiscard]] const DialectRules& fanuc_rules() noexcept;

/// Haas mills: the same reader and decoder, with Haas's words and rules (`haas_variant`).
[[nodiscard]] const DialectRules& haas_rules() noexcept;

}  // namespace steadyrest::nc::interpret
