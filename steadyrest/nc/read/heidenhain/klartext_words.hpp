// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <string_view>

#include <steadyrest/nc/read/text/block.hpp>

namespace steadyrest::nc::read {

/// What a block of `heidenhain` is, by the word that it begins with. The block's first `Word` has
/// no letter, that word as its name and this as its value; see function_of().
enum class Klartext : std::uint8_t {
  none,            ///< M words alone
  begin,           ///< BEGIN PGM; a word `MM` or `INCH` follows
  line,            ///< L, or an axis word alone
  polar_line,      ///< LP
  pole,            ///< CC
  circle,          ///< C
  polar_circle,    ///< CP
  radius_circle,   ///< CR
  tangent_circle,  ///< CT
  polar_tangent,   ///< CTP
  rounding,        ///< RND
  chamfer,         ///< CHF
  tool_call,       ///< TOOL CALL
  tool_def,        ///< TOOL DEF
  cycle_def,       ///< CYCL DEF; words `NUMBER`, `PART`, values and `COMPLETE` follow
  cycle_values,    ///< a further line of CYCL DEF: `COMPLETE` follows where it is the last
  cycle_call,      ///< CYCL CALL
  cycle_call_at,   ///< CYCL CALL POS
  stop             ///< STOP
};

/// Of the first word of a block.
[[nodiscard]] constexpr Klartext function_of(const Word& first) noexcept {
  return first.letter == 0 ? static_cast<Klartext>(static_cast<int>(first.value)) : Klartext::none;
}

/// What begins a block of the control, but is not interpreted.
struct RefusedFunction {
  std::string_view name;  ///< the block's first word, in capitals
  std::string_view reason;
  std::string_view text;
};

/// nullptr where the word is unknown.
[[nodiscard]] const RefusedFunction* refused_function(std::string_view upper_name) noexcept;

}  // namespace steadyrest::nc::read
