// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <string>

namespace steadyrest::nc::interpret {

/// A block that is not understood, and how far what it may have changed reaches.
///
/// From there on the program is read as if the block had done nothing, and nothing of it counts as
/// known until the text has said again all that the block may have changed.
struct OpaqueStretch {
  std::uint32_t line = 0;  ///< of the block
  /// The last line that depends on it: the one that says the last of what it may have changed.
  /// 0: the stretch is still open, at the program's end as well.
  std::uint32_t last_line = 0;
  std::string word;    ///< as written in the program
  std::string reason;  ///< stable identifier, as of a refusal
  std::string text;    ///< one sentence: why its effect is not known
  // Lets designated initialisers leave it out.
  // NOLINTNEXTLINE(readability-redundant-member-init)
  std::string file{};  ///< of a subprogram; empty = the program itself
};

}  // namespace steadyrest::nc::interpret
