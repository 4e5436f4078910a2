// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <string_view>

#include <steadyrest/nc/read/text/block.hpp>
#include <steadyrest/nc/read/text/line_cursor.hpp>
#include <steadyrest/nc/read/text/name.hpp>

namespace steadyrest::nc::read {

/// One line of a SINUMERIK program: letters with numbers (`X10`), assignments (`X=10`, `X=AC(10)`,
/// `CR=5`, `T="DRILL"`), names without a value (`SUPA`), calls (`MSG("…")`), `;` comments.
///
/// Reads variables, definitions and calls where the reader has values for them. A name that is not
/// in the reader's table is refused with the group it belongs to.
class SinumerikLine : private LineCursor {
 public:
  using LineCursor::LineCursor;

  bool read();

 private:
  bool header();
  bool block_number();
  bool comment();
  bool item();
  bool named(const char* word_begin);
  bool assigned(const char* word_begin, Word& word);
  bool qualified(const char* word_begin, Word& word);
  bool quoted(const char* word_begin, Word& word);
  bool message(const char* word_begin, Word& word);
  // sinumerik_address.cpp
  bool named_value(const char* word_begin, Word& word);
  bool numbered_address(const char* word_begin, Word& word);
  bool spindle_position(const char* word_begin, Word& word);
  bool pass_brackets(const char* word_begin, char open, char close);
  bool string_argument(const char* word_begin);
  // sinumerik_call.cpp
  bool statement(const char* word_begin, std::string_view name, bool& done);
  bool definition(const char* word_begin);
  bool head_of_subprogram(const char* word_begin);
  bool parameter_of_subprogram(const char* word_begin, std::size_t place);
  bool declaration(const char* word_begin);
  bool value_type(const char* word_begin, ValueType& type);
  bool variable_name(const char* word_begin, Name& name);
  bool parameter_assignment(const char* word_begin);
  bool variable_assignment(const char* word_begin, std::string_view name);
  bool assign(const char* word_begin, Lookup lookup);
  bool call(const char* word_begin, std::string_view name, FlowKind kind);
  bool modal_call(const char* word_begin);
  bool master_spindle(const char* word_begin);
  bool call_values(const char* word_begin);
  bool repeats(const char* word_begin);
  bool calculated(const char* word_begin, double& out);
  [[nodiscard]] char next() noexcept;
  [[nodiscard]] std::string_view letters() noexcept;

  // sinumerik_system.cpp
  bool system_variable(const char* word_begin);
  bool fine_offset(const char* word_begin);
  bool axis_letter(char& letter);
  bool take(std::string_view upper_text);

  // sinumerik_frame.cpp
  bool tool_data(const char* word_begin);
  bool stored_offset(const char* word_begin);
  bool offset_chain(const char* word_begin);
  bool offset_shift(const char* word_begin);

  bool plain_number(const char* word_begin, Word& word);
  bool refuse_value(const char* word_begin);
  bool refuse_character();
  bool push(const char* word_begin, Word& word);

  bool assigned_ = false;       ///< a variable was set
  bool repeats_given_ = false;  ///< P after a call
};

}  // namespace steadyrest::nc::read
