// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <optional>
#include <string>
#include <string_view>

namespace steadyrest::table {

/// What is wrong in a file, where, and the remedy.
struct Fault {
  std::size_t line = 0;  ///< 1-based; 0 = the file as a whole
  std::string what;
  std::string to_do;
};

/// The fault of a file that is no text of columns, judged by its first bytes (packed, UTF-16); none
/// when it may be one.
[[nodiscard]] std::optional<Fault> fault_of_kind(std::string_view first_bytes);

/// Without surrounding blanks, tabs and carriage returns.
[[nodiscard]] std::string_view trimmed(std::string_view text) noexcept;

/// In lower case, ASCII only.
[[nodiscard]] std::string lower(std::string_view text);

/// Whether the bytes are UTF-8.
[[nodiscard]] bool is_utf8(std::string_view text) noexcept;

/// UTF-8 from Windows' code page 1252, which has the µ, ° and ² of ISO 8859-1; what that has not
/// becomes `?`.
[[nodiscard]] std::string from_cp1252(std::string_view text);

/// At most 40 characters, with nothing that a terminal would interpret.
[[nodiscard]] std::string shown(std::string_view text);

}  // namespace steadyrest::table
