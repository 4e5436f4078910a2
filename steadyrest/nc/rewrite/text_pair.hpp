// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include <steadyrest/kernel/outcome/result.hpp>

namespace steadyrest::nc::rewrite {

/// The inserted lines of a changed program.
struct Inserted {
  std::vector<std::uint32_t> lines;  ///< their numbers
  std::string head;                  ///< the text of those of the head, one under the other
  std::size_t head_lines = 0;
};

/// Compares two programs byte by byte, inserted lines of `changed` left out. Refused at the first
/// line that differs otherwise.
[[nodiscard]] kernel::outcome::Result<Inserted> compare_text(const std::string& original,
                                                             const std::string& changed);

}  // namespace steadyrest::nc::rewrite
