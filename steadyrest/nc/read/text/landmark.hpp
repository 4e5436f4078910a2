// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <string_view>

#include <steadyrest/nc/read/text/block.hpp>

namespace steadyrest::nc::read {

/// What a line means for the map of its file: where a jump may go, what belongs together. Read
/// without values, so for any line, whether it is executed or not. Views refer to the line.
struct Landmark {
  /// A head or end of a structure, a jump, `label` (a program begins here), `back` (M99, M17, RET).
  FlowKind kind = FlowKind::none;
  bool deleted = false;   ///< begins with the block-delete mark
  bool numbered = false;  ///< has a block number
  std::uint32_t number = 0;
  std::string_view label;   ///< `NAME:` of sinumerik
  std::string_view name;    ///< of the program that begins; of a loop: its number or kind
  std::string_view target;  ///< of a jump, where it is written plainly
  Towards towards = Towards::either;
};

}  // namespace steadyrest::nc::read
