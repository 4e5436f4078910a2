// SPDX-License-Identifier: Apache-2.0
#include "source.hpp"

#include <algorithm>
#include <cctype>

// A lexer just good enough for the rules: it tells code from comments and literals, keeps every
// offset and line, and knows nothing else about C++.
namespace house {
namespace {

bool is_word_character(char c) {
  return std::isalnum(static_cast<unsigned char>(c)) != 0 || c == '_';
}

/// Turns [from, to) into blanks, keeps line breaks.
void blank(std::string& text, std::size_t from, std::size_t to) {
  for (std::size_t i = from; i < std::min(to, text.size()); ++i) {
    if (text[i] != '\n') {
      text[i] = ' ';
    }
  }
}

/// One past the closing quote of the literal that opens at `open`. It also ends at the line's end,
/// so that an apostrophe in unusual code cannot swallow the rest of the file.
std::size_t end_of_quoted(std::string_view text, std::size_t open) {
  const char quote = text[open];
  std::size_t i = open + 1;
  while (i < text.size() && text[i] != quote && text[i] != '\n') {
    i += text[i] == '\\' ? 2 : 1;
  }
  return std::min(i + 1, text.size());
}

/// One past R"tag(…)tag" whose quote is at `open`.
std::size_t end_of_raw(std::string_view text, std::size_t open) {
  const std::size_t bracket = text.find('(', open);
  if (bracket == std::string_view::npos) {
    return text.size();
  }
  const std::string closing = ")" + std::string(text.substr(open + 1, bracket - open - 1)) + "\"";
  const std::size_t end = text.find(closing, bracket);
  return end == std::string_view::npos ? text.size() : end + closing.size();
}

/// R, u8R, uR, UR and LR open a raw string; an identifier that ends in R does not.
bool opens_raw(std::string_view text, std::size_t quote) {
  return quote > 0 && text[quote - 1] == 'R' &&
         (quote == 1 || !is_word_character(text[quote - 2]) || text[quote - 2] == '8' ||
          text[quote - 2] == 'u' || text[quote - 2] == 'L' || text[quote - 2] == 'U');
}

}  // namespace

std::string blank_comments_and_literals(std::string_view text) {
  std::string out(text);
  std::size_t i = 0;
  while (i < text.size()) {
    std::size_t end = i + 1;
    if (text.substr(i, 2) == "//") {
      end = std::min(text.find('\n', i), text.size());
      blank(out, i, end);
    } else if (text.substr(i, 2) == "/*") {
      const std::size_t close = text.find("*/", i + 2);
      end = close == std::string_view::npos ? text.size() : close + 2;
      blank(out, i, end);
    } else if (text[i] == '"') {
      end = opens_raw(text, i) ? end_of_raw(text, i) : end_of_quoted(text, i);
      // The quotes stay, so that a quoted include is still seen as one.
      blank(out, i + 1, end - 1);
    } else if (text[i] == '\'' && (i == 0 || !is_word_character(text[i - 1]))) {
      // After a digit it separates thousands: 1'000.
      end = end_of_quoted(text, i);
      blank(out, i + 1, end - 1);
    }
    i = end;
  }
  return out;
}

std::vector<Include> includes(std::string_view text) {
  const std::string blanked = blank_comments_and_literals(text);
  std::vector<Include> found;
  for (std::size_t at = blanked.find('#'); at != std::string::npos;
       at = blanked.find('#', at + 1)) {
    std::size_t i = blanked.find_first_not_of(" \t", at + 1);
    if (i == std::string::npos || blanked.compare(i, 7, "include") != 0) {
      continue;
    }
    i = blanked.find_first_not_of(" \t", i + 7);
    if (i == std::string::npos || (blanked[i] != '<' && blanked[i] != '"')) {
      continue;
    }
    // The name is read from the original text: in the blanked one a quoted name is blank.
    const bool quoted = blanked[i] == '"';
    const std::size_t end = text.find(quoted ? '"' : '>', i + 1);
    if (end == std::string_view::npos) {
      continue;
    }
    found.push_back({std::string(text.substr(i + 1, end - i - 1)), quoted, line_of(text, at)});
  }
  return found;
}

std::vector<Word> words(std::string_view blanked) {
  std::vector<Word> found;
  std::size_t i = 0;
  while (i < blanked.size()) {
    if (!is_word_character(blanked[i])) {
      ++i;
      continue;
    }
    std::size_t end = i;
    while (end < blanked.size() && is_word_character(blanked[end])) {
      ++end;
    }
    found.push_back({blanked.substr(i, end - i), i});
    i = end;
  }
  return found;
}

std::size_t lines_in(std::string_view text) {
  return static_cast<std::size_t>(std::ranges::count(text, '\n'));
}

std::size_t line_of(std::string_view text, std::size_t offset) {
  return 1 + static_cast<std::size_t>(std::ranges::count(text.substr(0, offset), '\n'));
}

std::string_view folder_of(std::string_view path) {
  const std::size_t slash = path.rfind('/');
  return slash == std::string_view::npos ? std::string_view{} : path.substr(0, slash);
}

/// Whole folder names: `online` must not match `online_help`.
bool has_folder(std::string_view path, std::string_view folder) {
  const std::string padded = "/" + std::string(folder_of(path)) + "/";
  return padded.find("/" + std::string(folder) + "/") != std::string::npos;
}

}  // namespace house
