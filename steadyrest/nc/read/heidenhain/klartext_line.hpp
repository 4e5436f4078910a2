// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string_view>

#include <steadyrest/nc/read/heidenhain/klartext_words.hpp>
#include <steadyrest/nc/read/text/block.hpp>
#include <steadyrest/nc/read/text/line_cursor.hpp>

namespace steadyrest::nc::read {

/// One line of a Klartext program: block number, the word that says what the block is, its words, a
/// comment from `;` on. A line that begins with `*` or `;` is a comment.
///
/// `~` at the end of a line continues the definition of a cycle: each of its lines is read by
/// itself, so that a fault is named by its own line. The values of a cycle are assignments to its Q
/// parameters, as they are on the control.
class KlartextLine : private LineCursor {
 public:
  using LineCursor::LineCursor;

  bool read();

 private:
  bool block();
  bool block_number();
  bool comment();
  bool end_of_line();
  bool refuse_character();
  [[nodiscard]] std::string_view letters() noexcept;
  [[nodiscard]] bool take(std::string_view upper_text) noexcept;
  [[nodiscard]] bool at_end() noexcept;
  bool function(const char* word_begin, std::string_view name);
  [[nodiscard]] bool untilted() noexcept;
  [[nodiscard]] bool switches_off(std::string_view name) noexcept;
  bool path_function(const char* word_begin, std::string_view name, bool& found);
  bool open(const char* word_begin, Klartext function);
  Word* add(const char* word_begin);
  bool named(const char* word_begin, std::string_view name, double value);

  // words of a block: klartext_path.cpp
  bool words();
  bool word();
  bool axis_or_polar(const char* word_begin, bool incremental);
  bool radius_word(const char* word_begin);
  bool feed_word(const char* word_begin);
  bool direction(const char* word_begin);
  bool miscellaneous(const char* word_begin);
  bool value(const char* word_begin, double& out);
  bool number_word(const char* word_begin, char letter);

  // blocks with a syntax of their own: klartext_blocks.cpp
  bool begin_program(const char* word_begin);
  bool end_program(const char* word_begin);
  bool tool(const char* word_begin);
  bool tool_words(bool definition);
  bool call(const char* word_begin);
  bool label(const char* word_begin);
  bool label_name(const char* word_begin);
  bool call_file(const char* word_begin);
  bool fn(const char* word_begin);
  bool calculate(const char* word_begin, int number);
  bool jump(const char* word_begin, int number);
  bool assignment(const char* word_begin);
  bool assign(const char* word_begin, int index, double value);
  bool operand(const char* word_begin, double& out);

  // cycles: klartext_cycle.cpp
  bool cycle(const char* word_begin);
  bool cycle_definition(const char* word_begin);
  bool cycle_part(const char* word_begin, int number, int part);
  bool cycle_axes(int number);
  bool datum(const char* word_begin);
  bool cycle_values();
  bool further_values();

  bool continues_ = false;  ///< the line ends with ~
};

}  // namespace steadyrest::nc::read
