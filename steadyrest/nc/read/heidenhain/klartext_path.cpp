// SPDX-License-Identifier: Apache-2.0
#include <string>

#include <steadyrest/nc/read/heidenhain/klartext_expression.hpp>
#include <steadyrest/nc/read/heidenhain/klartext_line.hpp>
#include <steadyrest/nc/read/heidenhain/klartext_value.hpp>
#include <steadyrest/nc/read/text/character.hpp>

// The words of a path function: coordinates, compensation, feed and M words.
namespace steadyrest::nc::read {

bool KlartextLine::words() {
  while (!at_end()) {
    if (!is_letter(*at_)) {
      return refuse_character();
    }
    if (!word()) {
      return false;
    }
  }
  return true;
}

bool KlartextLine::word() {
  const char* const word_begin = at_;
  const char first = upper(*at_);
  const char second = at_ + 1 == end_ ? '\0' : upper(at_[1]);
  switch (first) {
    case 'I':
      ++at_;
      return axis_or_polar(word_begin, true);
    case 'P':
      return axis_or_polar(word_begin, false);
    case 'R':
      return radius_word(word_begin);
    case 'F':
      return feed_word(word_begin);
    case 'D':
      return direction(word_begin);
    case 'M':
      return miscellaneous(word_begin);
    default:
      break;
  }
  // LA of M120; TX, NX and others belong to LN.
  if (is_letter(second) && second != 'Q') {
    const std::string_view name = letters();
    double ignored = 0.0;
    if (name == "LA") {
      return value(word_begin, ignored) && named(word_begin, "LA", ignored);
    }
    return refuse(name, "unknown_word", "a word that does not belong to this block");
  }
  return axis_or_polar(word_begin, false);
}

bool KlartextLine::axis_or_polar(const char* word_begin, bool incremental) {
  const char letter = at_ == end_ ? '\0' : upper(*at_);
  if (letter == 'P') {
    ++at_;
    const char kind = at_ == end_ ? '\0' : upper(*at_);
    if (kind != 'R' && kind != 'A') {
      return refuse(since(word_begin), "unknown_word", "P begins PR or PA");
    }
    ++at_;
    double number = 0.0;
    if (!value(word_begin, number)) {
      return false;
    }
    Word* const word = add(word_begin);
    if (word == nullptr) {
      return false;
    }
    word->name = kind == 'R' ? "PR" : "PA";
    word->value = number;
    word->qualifier = incremental ? Qualifier::incremental : Qualifier::none;
    return true;
  }
  if (std::string_view("XYZABCUVW").find(letter) == std::string_view::npos || letter == '\0') {
    at_ += at_ == end_ ? 0 : 1;
    return refuse(since(word_begin), "unknown_word", "a word that does not belong to this block");
  }
  ++at_;
  double number = 0.0;
  if (!value(word_begin, number)) {
    return false;
  }
  Word* const word = add(word_begin);
  if (word == nullptr) {
    return false;
  }
  word->letter = letter;
  word->value = number;
  word->qualifier = incremental ? Qualifier::incremental : Qualifier::none;
  return true;
}

// R0, RL and RR are the compensation; R with a sign or a number is a radius.
bool KlartextLine::radius_word(const char* word_begin) {
  ++at_;
  const char next = at_ == end_ ? '\0' : upper(*at_);
  const bool alone = at_ == end_ || at_ + 1 == end_ ||
                     (!is_digit(at_[1]) && at_[1] != '.' && at_[1] != ',' && !is_letter(at_[1]));
  if (alone && (next == '0' || next == 'L' || next == 'R' || next == '+' || next == '-')) {
    ++at_;
    if (next == '+' || next == '-') {
      return refuse(since(word_begin), "cutter_comp",
                    "the compensation of a single axis (R+, R-) is not interpreted");
    }
    return named(word_begin, next == '0' ? "R0" : next == 'L' ? "RL" : "RR", 0.0);
  }
  double number = 0.0;
  return value(word_begin, number) && named(word_begin, "RADIUS", number);
}

bool KlartextLine::feed_word(const char* word_begin) {
  ++at_;
  skip_blanks();
  if (take("MAX")) {
    return named(word_begin, "FMAX", 0.0);
  }
  if (take("AUTO")) {
    return named(word_begin, "FAUTO", 0.0);
  }
  const char next = at_ == end_ ? '\0' : upper(*at_);
  if (next == 'U' || next == 'Z' || next == 'T') {
    ++at_;
    return refuse(since(word_begin), "feed_kind",
                  "a feed per revolution (FU), per tooth (FZ) or by time (FT) is not interpreted");
  }
  double number = 0.0;
  if (!value(word_begin, number)) {
    return false;
  }
  Word* const word = add(word_begin);
  if (word == nullptr) {
    return false;
  }
  word->letter = 'F';
  word->value = number;
  return true;
}

bool KlartextLine::direction(const char* word_begin) {
  if (!take("DR")) {
    ++at_;
    return refuse(since(word_begin), "unknown_word", "a word that does not belong to this block");
  }
  skip_blanks();
  const char sign = at_ == end_ ? '\0' : *at_;
  if (sign != '+' && sign != '-') {
    return refuse(since(word_begin), "missing_value",
                  "DR without its sign: DR+ is counter-clockwise, DR- clockwise");
  }
  ++at_;
  return named(word_begin, "DR", sign == '+' ? 1.0 : -1.0);
}

// M140 takes MB with a distance or MAX; what the decoder does not interpret it refuses by its M.
bool KlartextLine::miscellaneous(const char* word_begin) {
  ++at_;
  if (at_ != end_ && upper(*at_) == 'B') {
    ++at_;
    double ignored = 0.0;
    return (take("MAX") || value(word_begin, ignored)) && named(word_begin, "MB", 0.0);
  }
  return number_word(word_begin, 'M');
}

bool KlartextLine::number_word(const char* word_begin, char letter) {
  double number = 0.0;
  if (!value(word_begin, number)) {
    return false;
  }
  Word* const word = add(word_begin);
  if (word == nullptr) {
    return false;
  }
  word->letter = letter;
  word->value = number;
  return true;
}

bool KlartextLine::value(const char* word_begin, double& out) {
  skip_blanks();
  // Nearly every value is a number: the way through the parameters costs more.
  if (const Number number = read_klartext_number(rest()); number.length != 0) {
    at_ += number.length;
    out = number.value;
    if (at_ != end_ && (*at_ == '.' || *at_ == ',')) {
      ++at_;
      return refuse(since(word_begin), "bad_number",
                    "not a number; write digits and one point or comma");
    }
    return true;
  }
  return operand(word_begin, out);
}

bool KlartextLine::operand(const char* word_begin, double& out) {
  if (at_end()) {
    return refuse(since(word_begin), "missing_value", "a word without its value");
  }
  if (reading_.values == nullptr) {
    return refuse(since(word_begin), "parameter", "a Q parameter; only plain numbers are allowed");
  }
  KlartextExpression expression(line(), offset(), *reading_.values);
  const bool read = expression.read_operand(out);
  return behind(word_begin, expression, read);
}

}  // namespace steadyrest::nc::read
