// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <optional>
#include <string>
#include <string_view>

#include <steadyrest/nc/read/text/dialect.hpp>

namespace steadyrest::nc::rewrite {

/// How lines that replace others are written. The original stays in the program as a comment, so
/// strip() can put it back byte for byte:
///   ;STEADYREST was 2 N130 G3 X66 Y34 I-2 J0      fanuc: (STEADYREST was 2 N130 …)
///   N130 G3 X66.0123 Y34.5 I-2.0123 J0 F3010 ;STEADYREST new
///   G3 X66.0123 Y33.9 I-2.0123 J-0.5 ;STEADYREST new
/// The number says how many new lines follow. On fanuc, whose comments end at `)`, brackets, `;`,
/// `%`, `=` and bytes that are not printable ASCII are written as =XX.

/// The comment that keeps a line, without a line end.
[[nodiscard]] std::string was_text(read::Dialect dialect, std::string_view line,
                                   std::size_t new_lines);
/// A new line with its mark, without a line end.
[[nodiscard]] std::string new_text(read::Dialect dialect, std::string_view code);
/// A line so long that its comment would not fit into a block of this control.
[[nodiscard]] bool too_long_to_keep(read::Dialect dialect, std::string_view line);

/// What a comment keeps.
struct Was {
  std::string line;
  std::size_t new_lines = 0;
};
/// Nothing when the line is not such a comment.
[[nodiscard]] std::optional<Was> read_was(std::string_view line);
[[nodiscard]] bool is_new(std::string_view line) noexcept;
/// What new_text() made such a line of.
[[nodiscard]] std::string_view new_code(std::string_view line) noexcept;

/// A comment that begins with the tag, as a control or an editor may have changed it: what follows
/// the tag, in capitals and without blanks. Empty: the line has none.
[[nodiscard]] std::string changed_mark(std::string_view line);
/// The line was a part of such a replacement, or of its record in the head, whatever has become of
/// its letters, blanks and block number since.
[[nodiscard]] bool was_replacing(std::string_view line);

}  // namespace steadyrest::nc::rewrite
