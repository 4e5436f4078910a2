// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <string>

#include <steadyrest/nc/read/heidenhain/klartext_expression.hpp>
#include <steadyrest/nc/read/heidenhain/klartext_line.hpp>
#include <steadyrest/nc/read/heidenhain/klartext_value.hpp>
#include <steadyrest/nc/read/text/character.hpp>

// CYCL DEF and CYCL CALL. Names of cycles and values are in the control's language: only numbers
// count.
namespace steadyrest::nc::read {

bool KlartextLine::cycle(const char* word_begin) {
  if (take("CALL")) {
    if (take("PAT")) {
      return refuse(since(word_begin), "pattern", "CYCL CALL PAT is not interpreted");
    }
    const bool position = take("POS");
    return open(word_begin, position ? Klartext::cycle_call_at : Klartext::cycle_call) && words();
  }
  if (!take("DEF")) {
    return refuse(since(word_begin), "unknown_word", "CYCL is followed by DEF or CALL");
  }
  return cycle_definition(word_begin);
}

bool KlartextLine::cycle_definition(const char* word_begin) {
  skip_blanks();
  int number = 0;
  for (; at_ != end_ && is_digit(*at_) && number < 10'000; ++at_) {
    number = number * 10 + (*at_ - '0');
  }
  if (number == 0) {
    return refuse(since(word_begin), "missing_value", "CYCL DEF without the cycle's number");
  }
  if (!open(word_begin, Klartext::cycle_def) ||
      !named(word_begin, "NUMBER", static_cast<double>(number))) {
    return false;
  }
  if (end_ - at_ >= 2 && *at_ == '.' && is_digit(at_[1])) {
    ++at_;
    int part = 0;
    for (; at_ != end_ && is_digit(*at_) && part < 100; ++at_) {
      part = part * 10 + (*at_ - '0');
    }
    return cycle_part(word_begin, number, part);
  }
  return cycle_values();
}

// A cycle of the old kind, a block for each value: CYCL DEF 1.2 DEPTH -20.
bool KlartextLine::cycle_part(const char* word_begin, int number, int part) {
  if (!named(word_begin, "PART", static_cast<double>(part))) {
    return false;
  }
  if (part == 0) {
    while (at_ != end_ && *at_ != ';') {
      ++at_;
    }
    return true;
  }
  constexpr int kShift = 7;
  constexpr int kMirror = 8;
  constexpr int kPlane = 19;
  if (number == kShift || number == kMirror || number == kPlane) {
    return cycle_axes(number);
  }
  // The first number of the line is the value: its name comes before it, in any language.
  bool found = false;
  double number_found = 0.0;
  bool incremental = false;
  while (at_ != end_ && *at_ != ';') {
    const char* const from = at_;
    incremental = incremental || (upper(*at_) == 'I' && end_ - at_ > 3 && upper(at_[1]) == 'R' &&
                                  upper(at_[2]) == 'O' && upper(at_[3]) == 'T');
    if (read_klartext_number(rest()).length != 0 || read_q_name(rest()).length != 0 ||
        ((*at_ == '+' || *at_ == '-') && read_q_name(rest().substr(1)).length != 0)) {
      if (!value(from, number_found)) {
        return false;
      }
      found = true;
      while (at_ != end_ && *at_ != ';') {  // 32.2 HSC-MODE:1 TA5
        ++at_;
      }
      break;
    }
    ++at_;
  }
  if (!found) {
    return true;
  }
  Word* const word = add(word_begin);
  if (word == nullptr) {
    return false;
  }
  word->name = "VALUE";
  word->value = number_found;
  word->qualifier = incremental ? Qualifier::incremental : Qualifier::none;
  return true;
}

// CYCL DEF 7.1 X+60, 7.2 IY-5, 8.1 X Y.
bool KlartextLine::cycle_axes(int number) {
  constexpr int kMirrors = 8;
  while (!at_end()) {
    const char* const word_begin = at_;
    if (*at_ == '#') {
      at_ = end_;
      return refuse(since(word_begin), "datum_table",
                    "a datum from the control's table, which is not known here");
    }
    const bool incremental = upper(*at_) == 'I';
    at_ += incremental ? 1 : 0;
    if (number == kMirrors) {
      const char letter = at_ == end_ ? '\0' : upper(*at_);
      if (incremental || std::string_view("XYZABCUVW").find(letter) == std::string_view::npos) {
        return refuse(rest(), "unknown_word", "mirroring takes the letters of axes");
      }
      ++at_;
      if (!named(word_begin, "MIRROR", static_cast<double>(letter))) {
        return false;
      }
    } else if (!axis_or_polar(word_begin, incremental)) {
      return false;
    }
  }
  return true;
}

// TRANS DATUM AXIS X+10 and TRANS DATUM RESET are CYCL DEF 7 in one block.
bool KlartextLine::datum(const char* word_begin) {
  const bool reset = take("DATUM") && take("RESET");
  if (!reset && !take("AXIS")) {
    at_ = end_;
    return refuse(since(word_begin), "datum_shift",
                  "a datum shift other than TRANS DATUM AXIS and TRANS DATUM RESET");
  }
  constexpr double kShift = 7.0;
  if (!open(word_begin, Klartext::cycle_def) || !named(word_begin, "NUMBER", kShift) ||
      !named(word_begin, "PART", 1.0)) {
    return false;
  }
  if (!reset) {
    return cycle_axes(static_cast<int>(kShift));
  }
  return std::ranges::all_of(std::string_view("XYZ"), [&](char letter) {
    Word* const word = add(word_begin);
    if (word != nullptr) {
      word->letter = letter;
    }
    return word != nullptr;
  });
}

// Q200=+2 ;SET-UP CLEARANCE ~: an assignment to the parameter that the cycle reads.
bool KlartextLine::cycle_values() {
  while (at_ != end_ && *at_ != ';') {
    const char* const word_begin = at_;
    const QName name = read_q_name(rest());
    if (name.length == 0) {
      ++at_;
      continue;
    }
    at_ += name.length;
    if (!take("=")) {
      continue;
    }
    double number = 0.0;
    constexpr double kRapid = 99999.0;  // as the control's largest feed
    if (take("FMAX") || take("MAX")) {
      number = kRapid;
    } else if (!value(word_begin, number)) {
      return false;
    }
    if (reading_.values == nullptr) {
      return refuse(since(word_begin), "parameter", "a Q parameter where none is allowed");
    }
    if (!assign(word_begin, name.index, number)) {
      return false;
    }
  }
  reading_.continued = continues_ ? Continued::values : Continued::no;
  return continues_ || named(begin_, "COMPLETE", 0.0);
}

bool KlartextLine::further_values() {
  skip_blanks();
  const char* const word_begin = at_;
  while (at_ != end_ && !is_blank(*at_) && *at_ != '=') {
    ++at_;
  }
  if (!open(word_begin, Klartext::cycle_values)) {
    return false;
  }
  at_ = word_begin;
  return cycle_values() && comment();
}

}  // namespace steadyrest::nc::read
