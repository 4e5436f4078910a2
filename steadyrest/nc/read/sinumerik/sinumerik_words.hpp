// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <string_view>

namespace steadyrest::nc::read {

/// What the interpreter does with a word whose address is a name.
enum class WordRole : std::uint8_t {
  decoded,         ///< it acts: the decoder knows it
  without_effect,  ///< it moves nothing and changes no move
  dynamics         ///< it changes acceleration, jerk, speed limits or the course of the feed alone
};

/// A word of the language. The manuals are those of SINUMERIK 840D sl: "Fundamentals" (F), "Job
/// planning" (J), "Cycles" (C).
struct NamedWord {
  std::string_view name;  ///< in capitals
  WordRole role = WordRole::decoded;
  bool index = false;     ///< `ACC[X]=50`: [ ] may follow the name
  bool brackets = false;  ///< `FGROUP(X,Y)`: ( ) may follow the name; what is in them is not read
};

/// Any case; nullptr where the name is none of these.
[[nodiscard]] const NamedWord* named_word(std::string_view name) noexcept;

/// A cycle of the control, of which the interpreter executes some: CYCLE81, HOLES1, POCKET3 …
[[nodiscard]] bool names_cycle(std::string_view name) noexcept;

/// Names that the control defines for values of its cycles, in lower case: `_finish` is 1. False
/// where the name is none of these.
[[nodiscard]] bool predefined(std::string_view name, double& value) noexcept;

}  // namespace steadyrest::nc::read
