// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string_view>

/// The words of more than one letter in a SINUMERIK program, in any case.
namespace steadyrest::nc::read {

/// Whether they are equal regardless of case; `upper_name` is in capitals.
[[nodiscard]] bool equal(std::string_view text, std::string_view upper_name) noexcept;

/// Names that the interpreter knows. Everything else is refused.
[[nodiscard]] bool known_name(std::string_view name) noexcept;

struct RefusedName {
  std::string_view name;
  std::string_view reason;
  std::string_view text;
};
/// Why the name is refused, where there is a better reason than "not known"; else null.
[[nodiscard]] const RefusedName* refused_name(std::string_view name) noexcept;

/// Whether it is a word of jumps, conditions and loops: IF, GOTOF, REPEAT …
[[nodiscard]] bool is_flow_word(std::string_view name) noexcept;

}  // namespace steadyrest::nc::read
