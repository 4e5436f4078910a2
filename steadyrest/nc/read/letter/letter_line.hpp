// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <string_view>

#include <steadyrest/nc/read/text/block.hpp>
#include <steadyrest/nc/read/text/character.hpp>
#include <steadyrest/nc/read/text/reading.hpp>
#include <steadyrest/nc/read/text/values.hpp>

namespace steadyrest::nc::read {

/// One line of the dialects whose words are a letter and a number (`linuxcnc`, `fanuc`).
///
/// Blanks have no meaning outside of comments. Where the reader has values (`Reader::set_values`),
/// expressions, parameters and
/// assignments are read, of `linuxcnc` O-words too; else they are refused by name. In `fanuc` an
/// assignment is a macro statement, which stands in a block of its own.
class LetterLine {
 public:
  LetterLine(Reading& reading, std::string_view line, std::uint32_t number, Block& block) noexcept
      : reading_(reading),
        begin_(line.data()),
        at_(line.data()),
        end_(line.data() + line.size()),
        number_(number),
        block_(block) {}

  bool read();

 private:
  bool one_item();
  void plain_words() noexcept;
  bool round_comment();
  bool rest_of_line();
  bool delete_mark();
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
  void skip_blanks() noexcept {
    while (at_ != end_ && is_blank(*at_)) {
      ++at_;
    }
  }
  [[nodiscard]] std::string_view line() const noexcept {
    return {begin_, static_cast<std::size_t>(end_ - begin_)};
  }
  [[nodiscard]] std::string_view since(const char* from) const noexcept {
    return {from, static_cast<std::size_t>(at_ - from)};
  }
  bool refuse(std::string_view word, std::string_view reason, std::string_view text) {
    return reading_.refuse(number_, word, reason, text);
  }

  Reading& reading_;
  const char* begin_;
  const char* at_;
  const char* end_;
  std::uint32_t number_;
  Block& block_;
  bool assigned_ = false;  ///< a macro statement has been read
};

}  // namespace steadyrest::nc::read
