// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <map>
#include <string>
#include <vector>

#include <steadyrest/kernel/outcome/result.hpp>

namespace steadyrest::nc::rewrite {

struct PutBack {
  std::string text;         ///< the program without replaced blocks
  std::size_t removed = 0;  ///< new lines and lines of the mark taken out
  std::size_t restored = 0;
  /// What replaced lines of `text`, by their number, without marks: replace() with them makes
  /// `changed` again.
  std::map<std::uint32_t, std::vector<std::string>> lines;
};

/// Puts replaced lines back and takes their mark out (replaced_text.hpp); all other bytes stay,
/// inserted corrections too. Refused with the line: a group that does not have as many new lines as
/// it says, and new lines that belong to none.
[[nodiscard]] kernel::outcome::Result<PutBack> put_back(const std::string& changed);

}  // namespace steadyrest::nc::rewrite
