// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <steadyrest/nc/interpret/decode/dialect_rules.hpp>

namespace steadyrest::nc::interpret {

/// HEIDENHAIN iTNC 530 and TNC 640 programs in Klartext (not their DIN/ISO mode).
[[nodiscard]] const DialectRules& heidenhain_rules() noexcept;

}  // namespace steadyrest::nc::interpret
