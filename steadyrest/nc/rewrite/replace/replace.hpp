// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <map>
#include <string>
#include <string_view>
#include <vector>

#include <steadyrest/kernel/outcome/result.hpp>
#include <steadyrest/nc/read/text/dialect.hpp>
#include <steadyrest/nc/rewrite/text/mark.hpp>

namespace steadyrest::nc::rewrite {

/// What comes in place of lines, by their number; the texts have no marks. An empty list removes
/// the line: its place is taken by what replaces a line before it.
using NewLines = std::map<std::uint32_t, std::vector<std::string>>;

struct Replaced {
  std::string text;             ///< the changed program
  std::uint64_t replaced = 0;   ///< lines of the original
  std::uint64_t new_lines = 0;  ///< in their place
  /// The original's line of each line of the changed program, by number from 1; 0: the head's.
  std::vector<std::uint32_t> origin;
};

/// The program with these lines in place of its own, each original kept as a comment
/// (replaced_text.hpp), and a head that says how it was made. Line ends are those of the original.
/// With the same lines it is the program itself.
[[nodiscard]] kernel::outcome::Result<Replaced> replace(const std::string& program,
                                                        read::Dialect dialect,
                                                        const NewLines& lines,
                                                        const std::vector<Told>& told);

}  // namespace steadyrest::nc::rewrite
