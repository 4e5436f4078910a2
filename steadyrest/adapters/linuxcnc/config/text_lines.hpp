// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <string>
#include <string_view>
#include <vector>

#include <steadyrest/kernel/file/unified_diff.hpp>
#include <steadyrest/kernel/outcome/result.hpp>

namespace steadyrest::adapters::linuxcnc::config {

/// A configuration's file as text. Refused: none there, a folder, over 4 MB, binary.
[[nodiscard]] kernel::outcome::Result<std::string> read_text(const std::string& path);

using kernel::file::lines_of;

[[nodiscard]] std::string_view trimmed(std::string_view text) noexcept;

/// Words between blanks; double quotes keep blanks and are taken off.
[[nodiscard]] std::vector<std::string> words_of(std::string_view text);

/// A line, and those that a backslash at the end appends to it.
struct LogicalLine {
  std::size_t first = 0;  ///< 1-based
  std::size_t last = 0;
  std::string text;  ///< without line ends and backslashes
};
[[nodiscard]] std::vector<LogicalLine> logical_lines(std::string_view text);

}  // namespace steadyrest::adapters::linuxcnc::config
