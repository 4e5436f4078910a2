// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>

#include <steadyrest/nc/interpret/state/config.hpp>
#include <steadyrest/nc/interpret/state/refusals.hpp>
#include <steadyrest/nc/read/text/block.hpp>

namespace steadyrest::nc::interpret {

/// The arguments of a macro call (G65, G66), which become its local variables #1 … #33.
struct MacroArguments {
  static constexpr std::size_t kLocals = 34;  ///< #0 is none of them
  std::array<double, kLocals> value{};
  std::uint64_t given = 0;    ///< bit n: #n
  std::uint64_t unknown = 0;  ///< bit n: the control decides #n
};

/// Takes them from a block's words; false when one is refused.
///
/// Law of the Series 30i operator's manual, "Macro call", argument specification I and II: A #1,
/// B #2, C #3, I #4, J #5, K #6, D #7, E #8, F #9, H #11, M #13, Q #17 … Z #26; I, J and K again
/// #7 #8 #9, and so on up to ten times, in the order I J K of each group. Of two words for the same
/// variable the later counts. Where I, J and K do not say which group they belong to, a number
/// without a decimal point has a unit that depends on the control (E and F with
/// DecimalRule::least_increment), or an argument is before the G word, the call is refused.
bool macro_arguments(const read::Block& block, DecimalRule rule, double unit_mm, Refusals& refusals,
                     MacroArguments& out);

}  // namespace steadyrest::nc::interpret
