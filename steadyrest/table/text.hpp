// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <string>
#include <string_view>

namespace steadyrest::table {

/// What is wrong in a file, where, and the remedy.
struct Fault {
  std::size_t line = 0;  ///< 1-based; 0 = the file as a whole
  std::string what;
  std::string to_do;
};

/// Without surrounding blanks, tabs and carriage returns.
[[nodiscard]] std::string_view trimmed(std::string_view text) noexcept;

/// In lower case, ASCII only.
[[nodiscard]] std::string lower(std::string_view text);

/// At most 40 characters, with nothing that a terminal would interpret.
[[nodiscard]] std::string shown(std::string_view text);

}  // namespace steadyrest::table
