// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <string>
#include <string_view>
#include <vector>

#include <toml++/toml.h>

/// Edits of a machine file's text that leave every other byte as it was.
namespace steadyrest::passport {

/// Converts the parser's lines and columns to byte offsets. Its columns count characters, so the
/// continuation bytes of UTF-8 must be skipped.
class Places {
 public:
  explicit Places(std::string_view text);
  [[nodiscard]] std::size_t at(const toml::source_position& place) const;
  /// After the end of the line that contains `i`.
  [[nodiscard]] std::size_t line_end(std::size_t i) const;

 private:
  std::string_view text_;
  std::vector<std::size_t> lines_;
};

/// The [[axis]] of this name, if there is one.
[[nodiscard]] const toml::table* axis_of(const toml::table& root, std::string_view name);

struct Edit {
  std::size_t from = 0;
  std::size_t to = 0;
  std::string text;
};

/// The text with all edits, which must not overlap.
[[nodiscard]] std::string applied(std::string_view text, std::vector<Edit> edits);

/// Inserted text with the line ends of `of`: a mixed file confuses editors and version control.
[[nodiscard]] std::string with_line_ends(std::string text, std::string_view of);

}  // namespace steadyrest::passport
