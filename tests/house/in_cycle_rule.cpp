// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <cctype>

#include "file_check.hpp"

// What code in the control cycle may say; include_rules.cpp looks at its headers.
namespace house {
namespace {

/// <new> as a header is fine; `new` as a word is not.
bool is_in_preprocessor_line(std::string_view blanked, std::size_t offset) {
  const std::size_t newline = blanked.rfind('\n', offset);
  const std::size_t start = newline == std::string_view::npos ? 0 : newline + 1;
  const std::size_t first = blanked.find_first_not_of(" \t", start);
  return first != std::string_view::npos && blanked[first] == '#';
}

void check_words(FileCheck& check) {
  const auto& forbidden = check.rules.in_cycle_words;
  for (const Word& word : words(check.blanked)) {
    if (std::ranges::find(forbidden, word.text) != forbidden.end() &&
        !is_in_preprocessor_line(check.blanked, word.offset)) {
      check.report("in-cycle", line_of(check.blanked, word.offset),
                   "'" + std::string(word.text) + "' has no business in the cycle");
    }
  }
}

/// Blanks are removed first, since `while ( true )` is spelt in many ways; `origin` leads back to
/// the line.
void check_loops(FileCheck& check) {
  std::string dense;
  std::vector<std::size_t> origin;
  for (std::size_t i = 0; i < check.blanked.size(); ++i) {
    if (check.blanked[i] != ' ' && check.blanked[i] != '\n') {
      dense += check.blanked[i];
      origin.push_back(i);
    }
  }
  for (const std::string_view loop : {"while(true)", "while(1)", "for(;;)"}) {
    for (std::size_t at = dense.find(loop); at != std::string::npos;
         at = dense.find(loop, at + 1)) {
      check.report("in-cycle", line_of(check.blanked, origin[at]), "a loop without a bound");
    }
  }
}

/// update( after a type is a declaration; after `return`, `=`, `.` or at the start of a statement
/// it is a call.
bool follows_type(std::string_view blanked, std::size_t offset) {
  const std::size_t last = blanked.find_last_not_of(" \n", offset - 1);
  if (last == std::string_view::npos) {
    return false;
  }
  const bool is_type = std::isalnum(static_cast<unsigned char>(blanked[last])) != 0 ||
                       blanked[last] == '_' || blanked[last] == '>' || blanked[last] == '&' ||
                       blanked[last] == '*';
  return is_type && (last < 5 || blanked.substr(last - 5, 6) != "return");
}

bool is_declaration(std::string_view blanked, const Word& word) {
  const std::size_t open = word.offset + word.text.size();
  return open < blanked.size() && blanked[open] == '(' && word.offset > 0 &&
         (blanked[word.offset - 1] == ' ' || blanked[word.offset - 1] == '&') &&
         follows_type(blanked, word.offset);
}

/// Each declaration of `update(…)` must say noexcept before its end: an exception in the cycle
/// would end the process with the override still masked.
void check_noexcept(FileCheck& check) {
  const auto& functions = check.rules.noexcept_functions;
  for (const Word& word : words(check.blanked)) {
    if (std::ranges::find(functions, word.text) == functions.end() ||
        !is_declaration(check.blanked, word)) {
      continue;
    }
    const std::size_t open = word.offset + word.text.size();
    const std::size_t end = check.blanked.find_first_of(";{", open);
    if (check.blanked.substr(open, end - open).find("noexcept") == std::string::npos) {
      check.report("in-cycle", line_of(check.blanked, word.offset),
                   std::string(word.text) + "() must be noexcept");
    }
  }
}

}  // namespace

void check_code_in_cycle(FileCheck& check) {
  check_words(check);
  check_loops(check);
  if (check.file.path.ends_with(".hpp")) {
    check_noexcept(check);
  }
}

}  // namespace house
