// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <string>
#include <string_view>
#include <vector>

namespace house {

/// One file of the tree, path relative to the project's root with '/' between folders.
struct SourceFile {
  std::string path;
  std::string text;
};

struct Include {
  std::string target;  ///< the text between the brackets or quotes
  bool quoted = false;
  std::size_t line = 0;  ///< 1-based
};

struct Word {
  std::string_view text;
  std::size_t offset = 0;
};

/// The text with comments and the contents of string and character literals turned into blanks;
/// line breaks stay, so offsets and line numbers are those of the original.
[[nodiscard]] std::string blank_comments_and_literals(std::string_view text);

/// The #include lines outside of comments.
[[nodiscard]] std::vector<Include> includes(std::string_view text);

/// Identifiers and keywords of a blanked text.
[[nodiscard]] std::vector<Word> words(std::string_view blanked);

[[nodiscard]] std::size_t lines_in(std::string_view text);

[[nodiscard]] std::size_t line_of(std::string_view text, std::size_t offset);

/// `a/b` for `a/b/c.hpp`.
[[nodiscard]] std::string_view folder_of(std::string_view path);

/// Whether one of the path's folders has this name.
[[nodiscard]] bool has_folder(std::string_view path, std::string_view folder);

}  // namespace house
