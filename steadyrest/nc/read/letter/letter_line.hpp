// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <string_view>

#include <steadyrest/nc/read/text/block.hpp>
#include <steadyrest/nc/read/text/line_cursor.hpp>
#include <steadyrest/nc/read/text/values.hpp>

namespace steadyrest::nc::read {

inline constexpr std::string_view kControlCharacter =
    "a control character; the file is not text or is damaged";

/// How the dialects of LetterLine differ.
struct LetterRules {
  bool macros = false;            ///< custom macros and O numbers; else expressions and O-words
  bool colon_is_o = false;        ///< `:100` is O100
  bool symbols = false;           ///< `@`, `^` and `$` are letters
  bool numbered_delete = false;   ///< a digit after `/` belongs to it
  bool semicolon_ends = false;    ///< `;` ends the block; else it opens a comment
  bool plain_words_fast = false;  ///< plain_words() may read them
  bool acting_comments = false;   ///< the control executes some comments: (ABORT,…), (PY,…)
  bool loose_comments = false;    ///< `(` in a comment is text, and a line's end closes it
  bool numbers_programs = false;  ///< O is a program's number, not an O-word
  bool system_lines = false;      ///< `$…` is for the control, `! ~ ?` are read as they arrive
  bool corner_words = false;      ///< `,C` and `,R`
};
inline constexpr LetterRules kLinuxcncLetters{
    .symbols = true, .plain_words_fast = true, .acting_comments = true};
inline constexpr LetterRules kFanucLetters{.macros = true,
                                           .colon_is_o = true,
                                           .numbered_delete = true,
                                           .semicolon_ends = true,
                                           .corner_words = true};
inline constexpr LetterRules kGrblLetters{.plain_words_fast = true,
                                          .loose_comments = true,
                                          .numbers_programs = true,
                                          .system_lines = true};
inline constexpr LetterRules kMach3Letters{
    .plain_words_fast = true, .loose_comments = true, .numbers_programs = true};

/// One line of the dialects whose words are a letter and a number (`linuxcnc`, `fanuc`).
///
/// Blanks have no meaning outside comments. Where the reader has values (`Reader::set_values`), it
/// reads expressions, parameters and assignments, and the O-words of `linuxcnc`; otherwise it
/// refuses them by name. In `fanuc` an assignment is a macro statement, which needs its own block.
class LetterLine : private LineCursor {
 public:
  LetterLine(const LetterRules& rules, Reading& reading, std::string_view line,
             std::uint32_t number, Block& block) noexcept
      : LineCursor(reading, line, number, block), rules_(rules) {}

  bool read();

 private:
  bool one_item();
  void plain_words() noexcept;
  bool round_comment();
  bool rest_of_line();
  void note_comment(std::string_view comment);
  bool delete_mark();
  bool system_line();
  bool corner_word();
  bool word();
  bool value(const char* word_begin, Word& word);
  [[nodiscard]] bool digits_stand_apart() const noexcept;
  bool spaced_number(const char* word_begin, Word& word);
  bool o_word(const char* word_begin);
  bool program_number(const char* word_begin);
  bool macro_keyword();
  bool macro_statement();
  bool macro_value(const char* word_begin, Word& word);
  bool expression(const char* word_begin, Word& word);
  bool assignment();
  bool refuse_assignment(const char* from, Lookup lookup);
  bool refuse_value(const char* word_begin);
  bool refuse_character();

  const LetterRules& rules_;
  bool assigned_ = false;  ///< a macro statement has been read
};

}  // namespace steadyrest::nc::read
