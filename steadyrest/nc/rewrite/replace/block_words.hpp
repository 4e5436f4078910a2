// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <string_view>

#include <steadyrest/nc/read/text/block.hpp>
#include <steadyrest/nc/read/text/dialect.hpp>

namespace steadyrest::nc::rewrite {

/// What the words of a block say of motion and feed.
struct Says {
  bool motion = false;
  bool feed = false;
  bool plain = true;
  bool calculated = false;
  bool keeps = false;  ///< what is in force now, for later
};
[[nodiscard]] Says says(const read::Block& block, read::Dialect dialect);

/// The value is not a number as it is written: X#1, X[1+2], X=R1.
[[nodiscard]] bool is_calculated(const read::Word& word);
/// The first word of a block beyond a line or an arc in plain numbers with its feed; empty when
/// there is none.
[[nodiscard]] std::string_view word_beyond_a_cut(const read::Block& block);
/// The name of a comment that LinuxCNC acts on, such as `MSG` or `PROBEOPEN`; empty where there is
/// none, and in other dialects. A block that has one does more than cut.
[[nodiscard]] std::string active_comment(read::Dialect dialect, std::string_view line);

}  // namespace steadyrest::nc::rewrite
