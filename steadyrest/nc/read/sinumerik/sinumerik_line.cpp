// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <array>
#include <cstddef>
#include <string>

#include <steadyrest/nc/read/sinumerik/sinumerik_line.hpp>
#include <steadyrest/nc/read/sinumerik/sinumerik_names.hpp>
#include <steadyrest/nc/read/text/character.hpp>
#include <steadyrest/nc/read/text/number.hpp>

namespace steadyrest::nc::read {
namespace {

// A line is a header (mark, number, label), then words, statements or a call, then a comment.
// Statements are in sinumerik_call.cpp.

}  // namespace

bool SinumerikLine::read() {
  if (!header()) {
    return false;
  }
  for (;;) {
    skip_blanks();
    if (at_ == end_) {
      return true;
    }
    if (*at_ == ';') {
      return comment();
    }
    if (!item()) {
      return false;
    }
  }
}

// Block-delete mark, then block number (N10, :10) and label (NAME:).
bool SinumerikLine::header() {
  skip_blanks();
  if (at_ != end_ && *at_ == '/') {
    const char* const mark = at_++;
    block_.set_deleted();
    if (at_ != end_ && is_digit(*at_)) {
      ++at_;
      return refuse(since(mark), "block_delete_switch",
                    "a numbered block-delete switch; only the plain mark / is supported");
    }
    skip_blanks();
  }
  if (!block_number()) {
    return false;
  }
  const char* look = at_;
  while (look != end_ && in_name(*look)) {
    ++look;
  }
  const auto length = look - at_;
  if (length >= 2 && !is_digit(*at_) && look != end_ && *look == ':' &&
      !(look + 1 != end_ && look[1] == '=')) {
    at_ = look + 1;  // a label does nothing: jumps are refused
    skip_blanks();
  }
  return true;
}

// Block numbers have no effect; only jumps would need them, and those are refused.
bool SinumerikLine::block_number() {
  if (at_ == end_ || (upper(*at_) != 'N' && *at_ != ':')) {
    return true;
  }
  const char* const begin = at_;
  const char* digits = at_ + 1;
  const char* stop = digits;
  while (stop != end_ && is_digit(*stop)) {
    ++stop;
  }
  if (stop == digits) {
    if (*begin == ':') {
      ++at_;
      return refuse(since(begin), "missing_value", "a block number without its digits");
    }
    return true;  // a name that begins with N
  }
  at_ = stop;
  skip_blanks();
  return true;
}

bool SinumerikLine::comment() {
  for (; at_ != end_; ++at_) {
    if (is_control(*at_)) {
      return refuse({at_, 1}, "control_character",
                    "a control character; the file is not text or is damaged");
    }
  }
  return true;
}

bool SinumerikLine::push(const char* word_begin, Word& word) {
  if (word.qualifier != Qualifier::text) {
    word.text = since(word_begin);
  }
  if (assigned_) {
    return refuse(since(word_begin), "assignment_and_words",
                  "a word next to a variable assignment; write two blocks");
  }
  if (!block_.push(word)) {
    return refuse(since(word_begin), "too_many_words", "more words than a block may have (128)");
  }
  return true;
}

bool SinumerikLine::item() {
  if (*at_ == '$' && reading_.typed_values != nullptr) {
    return system_variable(at_);
  }
  if (!is_letter(*at_) && *at_ != '_') {
    return refuse_character();
  }
  const char* const word_begin = at_;
  if (block_.flow().kind != FlowKind::none) {
    return repeats(word_begin);
  }
  // One letter is an address, two or more are a name: X1, but TRANS.
  const bool name_follows = at_ + 1 != end_ && (is_letter(at_[1]) || at_[1] == '_');
  if (name_follows || *at_ == '_') {
    return named(word_begin);
  }
  Word word;
  word.letter = upper(*at_++);
  word.name = {word_begin, 1};
  if (word.letter == 'N') {
    return refuse(since(word_begin), "misplaced_n", "a block number after other words");
  }
  if (word.letter == 'R' && reading_.typed_values != nullptr) {
    return parameter_assignment(word_begin);
  }
  if (word.letter == 'L' && reading_.typed_values != nullptr) {
    while (at_ != end_ && is_digit(*at_)) {
      ++at_;
    }
    return call(word_begin, since(word_begin), FlowKind::call);
  }
  if (word.letter == 'R') {
    while (at_ != end_ && !is_blank(*at_)) {
      ++at_;
    }
    return refuse(since(word_begin), "parameter",
                  "an R-parameter; only plain numbers are supported");
  }
  skip_blanks();
  if (at_ != end_ && *at_ == '=') {
    ++at_;
    return assigned(word_begin, word);
  }
  if (!plain_number(word_begin, word)) {
    return false;
  }
  if (at_ != end_ && *at_ == '=') {
    return numbered_address(word_begin, word);
  }
  return push(word_begin, word);
}

// X10 without = takes a plain number only; X1+2 is not allowed.
bool SinumerikLine::plain_number(const char* word_begin, Word& word) {
  const Number number = read_number(rest());
  if (number.length == 0) {
    return refuse_value(word_begin);
  }
  at_ += number.length;
  if (at_ != end_ &&
      (*at_ == '.' || (end_ - at_ >= 2 && upper(*at_) == 'E' && upper(at_[1]) == 'X'))) {
    while (at_ != end_ && !is_blank(*at_)) {
      ++at_;
    }
    return refuse(since(word_begin), "bad_number",
                  "not a number in the supported form; write digits and one point");
  }
  const char* look = at_;
  while (look != end_ && is_blank(*look)) {
    ++look;
  }
  if (look != end_ && (*look == '+' || *look == '-' || *look == '*')) {
    at_ = end_;
    return refuse(since(word_begin), "expression",
                  "an expression without = before it; write X=1+2");
  }
  word.value = number.value;
  word.decimal_point = number.decimal_point;
  word.has_value = true;
  return true;
}

bool SinumerikLine::named(const char* word_begin) {
  while (at_ != end_ && in_name(*at_)) {
    ++at_;
  }
  Word word;
  word.name = since(word_begin);
  if (equal(word.name, "MSG")) {
    return message(word_begin, word);
  }
  bool done = false;
  if (!statement(word_begin, word.name, done) || done) {
    return done;
  }
  if (!known_name(word.name)) {
    if (const RefusedName* const refused = refused_name(word.name)) {
      return refuse(word.name, refused->reason, refused->text);
    }
    skip_blanks();
    if (at_ != end_ && *at_ == '=') {
      return refuse(word.name, "variable", "an unknown variable or word");
    }
    if (at_ != end_ && *at_ == '(') {
      return refuse(word.name, "subprogram_call", "the call of a cycle or subprogram");
    }
    return refuse(word.name, "unknown_word", "a word that is not known");
  }
  return named_value(word_begin, word);
}

bool SinumerikLine::assigned(const char* word_begin, Word& word) {
  skip_blanks();
  if (at_ != end_ && *at_ == '"') {
    return quoted(word_begin, word);
  }
  if (end_ - at_ >= 3 && is_letter(*at_) && is_letter(at_[1])) {
    return qualified(word_begin, word);
  }
  if (reading_.typed_values == nullptr) {
    return plain_number(word_begin, word) && push(word_begin, word);
  }
  const Number number = read_number(rest());
  const char* look = at_ + number.length;
  while (look != end_ && is_blank(*look)) {
    ++look;
  }
  if (number.length != 0 && (look == end_ || *look == ';')) {
    at_ = look;
    word.value = number.value;
    word.decimal_point = number.decimal_point;
    word.has_value = true;
    return push(word_begin, word);
  }
  return calculated(word_begin, word.value) && ((word.has_value = word.calculated = true)) &&
         push(word_begin, word);
}

// X=AC(…) or X=IC(…); any other two letters begin an expression.
bool SinumerikLine::qualified(const char* word_begin, Word& word) {
  const std::string_view head{at_, 2};
  const bool absolute = equal(head, "AC");
  const char* look = at_ + 2;
  while (look != end_ && is_blank(*look)) {
    ++look;
  }
  if ((!absolute && !equal(head, "IC")) || look == end_ || *look != '(') {
    return reading_.typed_values == nullptr
               ? refuse_value(word_begin)
               : calculated(word_begin, word.value) && ((word.has_value = true)) &&
                     push(word_begin, word);
  }
  at_ = look + 1;
  if (!calculated(word_begin, word.value)) {
    return false;
  }
  skip_blanks();
  if (at_ == end_ || *at_ != ')') {
    at_ = end_;
    return refuse(since(word_begin), "unclosed_expression",
                  "AC( ) or IC( ) is not closed, or an operator is missing");
  }
  ++at_;
  word.qualifier = absolute ? Qualifier::absolute : Qualifier::incremental;
  word.has_value = true;
  return push(word_begin, word);
}

bool SinumerikLine::quoted(const char* word_begin, Word& word) {
  const char* const open = ++at_;
  while (at_ != end_ && *at_ != '"') {
    if (is_control(*at_)) {
      return refuse({at_, 1}, "control_character", "a control character in a string");
    }
    ++at_;
  }
  if (at_ == end_) {
    return refuse(since(word_begin), "unclosed_string", "a string without its closing quote");
  }
  word.qualifier = Qualifier::text;
  word.text = since(open);
  ++at_;
  return push(word_begin, word);
}

// MSG("text") or MSG(): a message for the operator, as harmless as a comment.
bool SinumerikLine::message(const char* word_begin, Word& word) {
  skip_blanks();
  if (at_ != end_ && *at_ == '(') {
    ++at_;
    skip_blanks();
    if (at_ != end_ && *at_ == '"' && !quoted(word_begin, word)) {
      return false;
    }
    skip_blanks();
    if (at_ != end_ && *at_ == ')') {
      ++at_;
      return true;
    }
  }
  at_ = end_;
  return refuse(since(word_begin), "expression", "MSG takes one plain string: MSG(\"text\")");
}

bool SinumerikLine::refuse_value(const char* word_begin) {
  const bool empty = at_ == end_;
  const char c = empty ? ' ' : *at_;
  const bool number = is_digit(c) || c == '.' || c == '-' || c == '+';
  while (at_ != end_ && !is_blank(*at_)) {
    ++at_;
  }
  const std::string_view text = since(word_begin);
  if (empty || c == ';') {
    return refuse(text, "missing_value", "an address without its value");
  }
  if (number) {
    return refuse(text, "bad_number", "not a number; write digits and one point");
  }
  if (c == '$') {
    return refuse(text, "parameter", "a system variable ($...); only plain numbers are supported");
  }
  if (is_control(c)) {
    return refuse(text, "control_character", "a control character");
  }
  return refuse(text, "expression",
                "a variable, function or expression as a value; only plain numbers are supported");
}

bool SinumerikLine::refuse_character() {
  const std::string_view text = rest();
  const char c = *at_;
  if (c == '$') {
    return refuse(text, "parameter", "system variables ($...) are not supported");
  }
  if (c == '(') {
    return refuse(text, "bad_character", "( begins no word; comments begin with ; in this dialect");
  }
  if (c == '/') {
    return refuse(text, "misplaced_block_delete", "the block-delete mark / after other text");
  }
  if (c == '%') {
    return refuse(text, "misplaced_percent", "% must be at the beginning of a line");
  }
  if (is_control(c)) {
    return refuse(text.substr(0, 1), "control_character",
                  "a control character; the file is not text or is damaged");
  }
  if (text.starts_with("\xef\xbb\xbf")) {
    return refuse(text.substr(0, 3), "byte_order_mark",
                  "a byte order mark; save the program as plain text without one");
  }
  if (static_cast<unsigned char>(c) >= 0x80) {
    return refuse(text.substr(0, 1), "not_ascii", "a non-ASCII character outside a comment");
  }
  return refuse(text, "bad_character", "a character that begins no word");
}

}  // namespace steadyrest::nc::read
