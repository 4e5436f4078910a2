// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <steadyrest/nc/interpret/decode/dialect_rules.hpp>

namespace steadyrest::nc::interpret {

/// Grbl 1.1 as its senders feed it, with the cycles and tool words of grblHAL. Both follow
/// RS274/NGC: their words mean what LinuxCNC's do, fewer of them are known.
[[nodiscard]] const DialectRules& grbl_rules() noexcept;

/// Mach3 milling: RS274/NGC words, subprograms by number (M98 P L, M99), parameters by number.
[[nodiscard]] const DialectRules& mach3_rules() noexcept;

}  // namespace steadyrest::nc::interpret
