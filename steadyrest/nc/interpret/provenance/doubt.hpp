// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>

#include <steadyrest/nc/interpret/state/asked.hpp>

namespace steadyrest::nc::interpret {

/// What one line depends on that is not known.
struct Doubt {
  /// Whether it is executed, or what it does to the machine's place or to the meaning of the blocks
  /// behind it, is the control's decision.
  bool line = false;
  /// It is in an opaque stretch: what a block that is not understood may have changed has not been
  /// said again before it.
  bool opaque = false;
  std::uint32_t axes = 0;  ///< work positions that are not known before it, a mask
  ModeMask unset = 0;      ///< modes that the text has not settled, as the line leaves them
  ModeMask lost = 0;       ///< those among them that lines before set in some runs alone
};

}  // namespace steadyrest::nc::interpret
