// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <array>
#include <cstddef>

#include <steadyrest/nc/read/letter/expression.hpp>
#include <steadyrest/nc/read/letter/letter_line.hpp>
#include <steadyrest/nc/read/letter/o_word.hpp>
#include <steadyrest/nc/read/text/character.hpp>
#include <steadyrest/nc/read/text/name.hpp>
#include <steadyrest/nc/read/text/number.hpp>

namespace steadyrest::nc::read {
namespace {

// A number continues after blanks: `1 . 5` is 1.5 in these dialects.
constexpr bool continues_number(char c) noexcept {
  return is_digit(c) || c == '.';
}

const char* behind_blanks(const char* at, const char* end) noexcept {
  return std::find_if_not(at, end, is_blank);
}

constexpr std::string_view kBadNumberText =
    "not a number; write one sign at most, digits and one point, within the range of a double";
constexpr std::string_view kStatementText = "in this dialect an assignment needs a separate block";

}  // namespace

// Words one after another; assignments act when the whole line has been read. plain_word.cpp reads
// the plain words that make up nearly every line; O-words, macros and expressions have their own
// files.
bool LetterLine::read() {
  skip_blanks();
  if (at_ != end_ && *at_ == '/' && !delete_mark()) {
    return false;
  }
  for (;;) {
    skip_blanks();
    plain_words();
    if (at_ != end_ && rules_.system_lines && (*at_ == '~' || *at_ == '?')) {
      ++at_;  // cycle start and a question for the status: nothing moves otherwise
      continue;
    }
    if (at_ == end_) {
      return true;
    }
    if (!one_item()) {
      return false;
    }
  }
}

bool LetterLine::one_item() {
  const char c = *at_;
  if (is_letter(c)) {
    return (!rules_.macros || macro_keyword()) && word();
  }
  if (c == ':' && rules_.colon_is_o) {
    return program_number(at_++);
  }
  if (c == '(') {
    return round_comment();
  }
  if (c == ';') {
    return rest_of_line();
  }
  if (c == '#' && reading_.values != nullptr) {
    reading_.numbers_alone = false;
    return rules_.macros ? macro_statement() : assignment();
  }
  if ((c == '@' || c == '^' || c == '$') && rules_.symbols) {
    return word();
  }
  if ((c == '$' || c == '!') && rules_.system_lines) {
    return system_line();
  }
  if (c == ',' && rules_.corner_words) {
    return corner_word();
  }
  return refuse_character();
}

bool LetterLine::delete_mark() {
  const char* const mark = at_++;
  block_.set_deleted();
  skip_blanks();
  if (rules_.numbered_delete && at_ != end_ && is_digit(*at_)) {
    ++at_;
    return refuse(since(mark), "block_delete_switch",
                  "a numbered block-delete switch; only the plain mark / is supported");
  }
  return true;
}

bool LetterLine::word() {
  const char* const word_begin = at_;
  Word word;
  word.letter = upper(*at_++);
  if (word.letter == 'O') {
    return o_word(word_begin);
  }
  if (block_.flow().kind != FlowKind::none) {
    at_ = end_;
    return refuse(since(word_begin), "o_word",
                  "words after an O-word; write them on a separate line");
  }
  if (!value(word_begin, word)) {
    return false;
  }
  if (assigned_) {
    return refuse(since(word_begin), "macro_statement", kStatementText);
  }
  word.has_value = true;
  word.unknown = reading_.values != nullptr && reading_.values->take_unknown();
  word.text = since(word_begin);
  word.name = {word_begin, 1};
  if (word.letter == 'N') {
    if (!block_.words().empty()) {
      return refuse(word.text, "misplaced_n", "a line number after other words; it comes first");
    }
    const char* const rest = behind_blanks(at_, end_);
    if (rest != end_ && upper(*rest) == 'N') {
      return refuse(word.text, "misplaced_n", "a second line number on one line");
    }
    return true;
  }
  if (!block_.push(word)) {
    return refuse(word.text, "too_many_words", "more words than a block may have (128)");
  }
  return true;
}

bool LetterLine::value(const char* word_begin, Word& word) {
  skip_blanks();
  const Number number = read_number({at_, static_cast<std::size_t>(end_ - at_)});
  if (number.length == 0 && digits_stand_apart()) {
    return spaced_number(word_begin, word);
  }
  if (number.length == 0) {
    reading_.numbers_alone = false;
    return reading_.values != nullptr ? expression(word_begin, word) : refuse_value(word_begin);
  }
  at_ += number.length;
  word.value = number.value;
  word.decimal_point = number.decimal_point;
  if (at_ == end_ || (!is_blank(*at_) && *at_ != '.')) {
    return true;
  }
  const char* const look = behind_blanks(at_, end_);
  return look == end_ || !continues_number(*look) || spaced_number(word_begin, word);
}

/// `Z- 1`, `Z. 5`, `Z-. 5`: blanks after a sign or a point that begins a number.
bool LetterLine::digits_stand_apart() const noexcept {
  const bool sign = at_ != end_ && (*at_ == '-' || *at_ == '+');
  const char* digits = sign ? behind_blanks(at_ + 1, end_) : at_;
  if (digits != end_ && *digits == '.') {
    digits = behind_blanks(digits + 1, end_);
  }
  return digits != end_ && is_digit(*digits);
}

bool LetterLine::spaced_number(const char* word_begin, Word& word) {
  std::array<char, 256> packed{};
  std::size_t length = 0;
  at_ = word_begin + 1;
  for (; at_ != end_ && length < packed.size(); ++at_) {
    if (continues_number(*at_) || (length == 0 && (*at_ == '-' || *at_ == '+'))) {
      packed[length++] = *at_;
    } else if (!is_blank(*at_)) {
      break;
    }
  }
  const Number number = read_number({packed.data(), length});
  if (number.length == 0 || number.length != length) {
    return refuse(since(word_begin), "bad_number", kBadNumberText);
  }
  word.value = number.value;
  word.decimal_point = number.decimal_point;
  return true;
}

// A value that is not a plain number: `X#5`, `X[…]`, `X-#5`, `XSIN[…]`.
bool LetterLine::expression(const char* word_begin, Word& word) {
  const bool signs = at_ != end_ && (*at_ == '-' || *at_ == '+');
  const char* look = at_;
  while (look != end_ && (is_blank(*look) || *look == '-' || *look == '+')) {
    ++look;
  }
  if (look == end_ || (signs && (is_digit(*look) || *look == '.')) ||
      !(*look == '#' || *look == '[' || is_letter(*look))) {
    return refuse_value(word_begin);
  }
  if (rules_.macros) {
    return macro_value(word_begin, word);
  }
  Expression expression(line(), offset(), *reading_.values);
  if (!expression.read(word.value)) {
    if (is_letter(*look) && expression.reason() == "missing_value") {
      return refuse_value(word_begin);
    }
    return behind(word_begin, expression, false);
  }
  at_ += expression.length();
  word.decimal_point = true;  // a calculated value is in units, never in increments
  return true;
}

bool LetterLine::refuse_assignment(const char* from, Lookup lookup) {
  return lookup == Lookup::found ||
         (lookup == Lookup::no_such_number
              ? refuse(since(from), "no_such_parameter", "a parameter the control does not have")
              : refuse(since(from), "read_only_parameter", "a read-only parameter"));
}

// `#5 = …`, `#<name> = …`: acts when the whole line has been read.
bool LetterLine::assignment() {
  const char* const from = at_++;
  skip_blanks();
  Name name;
  int index = 0;
  const bool named = at_ != end_ && *at_ == '<';
  if (named) {
    const char* const after = read_name(at_, end_, name);
    if (after == nullptr) {
      at_ = end_;
      return refuse(since(from), "bad_parameter",
                    "a parameter name that is empty, too long or not closed by >");
    }
    at_ = after;
  } else {
    Expression number(line(), offset(), *reading_.values);
    if (!behind(from, number, number.parameter_number(index))) {
      return false;
    }
    if (reading_.values->take_unknown()) {
      reading_.values->sets_any();
    }
  }
  skip_blanks();
  if (at_ == end_ || *at_ != '=') {
    return refuse(since(from), "bad_assignment", "a parameter without an assignment; write #5 = 2");
  }
  ++at_;
  double value = 0.0;
  Expression right(line(), offset(), *reading_.values);
  if (!behind(from, right, right.read(value))) {
    return false;
  }
  return refuse_assignment(from, named ? reading_.values->set_name(name.view(), value)
                                       : reading_.values->set_number(index, value));
}

bool LetterLine::o_word(const char* word_begin) {
  reading_.numbers_alone = false;
  if (reading_.values == nullptr || rules_.macros || rules_.numbers_programs) {
    return program_number(word_begin);
  }
  if (!block_.words().empty() || block_.flow().kind != FlowKind::none) {
    at_ = end_;
    return refuse(since(word_begin), "o_word", "an O-word after other words; it comes first");
  }
  OWord word(line(), offset(), *reading_.values);
  return behind(word_begin, word, word.read(block_.flow(), true));
}

bool LetterLine::program_number(const char* word_begin) {
  skip_blanks();
  const Number number = read_number({at_, static_cast<std::size_t>(end_ - at_)});
  at_ += number.length;
  const bool integer =
      number.length != 0 && !number.decimal_point && is_digit(*(at_ - 1)) && number.value >= 0.0;
  for (skip_blanks(); integer && at_ != end_ && (*at_ == '(' || *at_ == ';'); skip_blanks()) {
    if (!(*at_ == '(' ? round_comment() : rest_of_line())) {
      return false;
    }
  }
  if (!integer || at_ != end_ || !block_.words().empty()) {
    at_ = end_;
    return refuse(since(word_begin), "o_word",
                  "an O-word (subprogram, loop or condition); only a program number alone on its "
                  "line is supported");
  }
  block_.flow().kind = FlowKind::label;
  return true;
}

bool LetterLine::refuse_value(const char* word_begin) {
  if (at_ == end_) {
    return refuse(since(word_begin), "missing_value", "a letter without its number");
  }
  const char c = *at_;
  const char* stop = at_;
  while (stop != end_ && !is_blank(*stop)) {
    ++stop;
  }
  at_ = stop;
  const std::string_view text = since(word_begin);
  if (c == '#') {
    return refuse(text, "parameter", "a parameter (#); only plain numbers are supported");
  }
  if (c == '[') {
    return refuse(text, "expression", "an expression ([...]); only plain numbers are supported");
  }
  if (is_letter(c)) {
    const char* name_end = word_begin + 1;
    while (name_end != end_ && (is_letter(*name_end) || is_blank(*name_end))) {
      ++name_end;
    }
    if (name_end != end_ && *name_end == '[') {
      return refuse(text, "expression", "a function; only plain numbers are supported");
    }
    return refuse(text, "missing_value", "a letter without its number");
  }
  if (c == '+' || c == '-' || is_digit(c) || c == '.') {
    return refuse(text, "bad_number", kBadNumberText);
  }
  if (is_control(c)) {
    return refuse({word_begin, 1}, "control_character", kControlCharacter);
  }
  return refuse(text, "missing_value", "a letter without its number");
}

bool LetterLine::refuse_character() {
  const char c = *at_;
  if (c == '#') {
    return refuse(rest(), "parameter", "a parameter (#); assignments are not supported");
  }
  if (c == '[') {
    return refuse(rest(), "expression", "text in [ ] that belongs to no word");
  }
  if (is_control(c)) {
    return refuse(rest().substr(0, 1), "control_character", kControlCharacter);
  }
  if (c == '@' || c == '^') {
    return refuse(rest(), "polar_coordinates", "polar coordinates (@ ^) are not supported");
  }
  if (c == '$') {
    return refuse(rest(), "spindle_selection", "choosing a spindle ($) is not supported");
  }
  if (c == '/') {
    return refuse(rest(), "misplaced_block_delete", "the block-delete mark / after other text");
  }
  if (c == '%') {
    return refuse(rest(), "misplaced_percent",
                  "% must be alone on its line, as the first and last line of the program");
  }
  if (c == ')') {
    return refuse(rest(), "unopened_comment", "a ) without its (");
  }
  if (rest().starts_with("\xef\xbb\xbf")) {
    return refuse(rest().substr(0, 3), "byte_order_mark",
                  "a byte order mark; save the program as plain text without one");
  }
  if (static_cast<unsigned char>(c) >= 0x80) {
    return refuse(rest().substr(0, 1), "not_ascii", "a non-ASCII character outside a comment");
  }
  return refuse(rest(), "bad_character", "a character that begins no word");
}

}  // namespace steadyrest::nc::read
