// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>

#include <steadyrest/kernel/outcome/result.hpp>
#include <steadyrest/nc/rewrite/walk/walk.hpp>

namespace steadyrest::nc::rewrite {

/// A line that affects the frame that holds a correction, or the program's end; where the frame is
/// kept and the program does not end, the line sets the offset.
struct FrameLine {
  std::uint32_t line = 0;
  std::uint32_t top_line = 0;
  Frame frame = Frame::kept;
  bool ends = false;
  bool may_write = false;
  bool moves_axis = false;
  bool incremental_before = false;
  bool incremental_behind = false;
  std::size_t before = 0;  ///< active offset
  std::size_t behind = 0;
  double unit_before_mm = 1.0;
  double unit_behind_mm = 1.0;
};

/// Why a correction of the axis may not be in force at the line; nothing where it can come off
/// before it (and go on again after it, unless the program ends there).
[[nodiscard]] std::optional<kernel::outcome::Refusal> fault_of(const FrameLine& frame, char letter,
                                                               const std::string& program);

}  // namespace steadyrest::nc::rewrite
