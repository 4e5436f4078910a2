// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <string_view>

namespace steadyrest::kernel::outcome {

/// Names that others chose, for a terminal or a page: what would not be seen, or would change how
/// the rest is seen, is escaped. These are control characters (`\x1b`, `\n`), the marks that turn
/// the direction of writing or have no width (`\u202e`), and bytes that are not UTF-8 (`\xff`).
[[nodiscard]] std::string shown(std::string_view name);

/// The same for a text of several lines: line ends and tabs stay.
[[nodiscard]] std::string shown_lines(std::string_view text);

/// The same for JSON: its meaning does not change, since such characters are in strings alone.
[[nodiscard]] std::string shown_json(std::string_view json);

}  // namespace steadyrest::kernel::outcome
