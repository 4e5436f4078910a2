// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <cstdint>
#include <limits>

#include <steadyrest/nc/read/sinumerik/sinumerik_line.hpp>
#include <steadyrest/nc/read/sinumerik/sinumerik_names.hpp>
#include <steadyrest/nc/read/sinumerik/sinumerik_words.hpp>
#include <steadyrest/nc/read/text/character.hpp>

// What follows an address of more than one character: CTOL=0.01, ACC[X]=50, FGROUP(X,Y), S2=500.
namespace steadyrest::nc::read {

/// Passes over ( ) or [ ], with strings and further brackets in them; at_ is at the opening one.
bool SinumerikLine::pass_brackets(const char* word_begin, char open, char close) {
  int depth = 0;
  bool text = false;
  for (; at_ != end_; ++at_) {
    if (is_control(*at_)) {
      return refuse({at_, 1}, "control_character", "a control character in brackets");
    }
    text = text != (*at_ == '"');
    depth += text ? 0 : *at_ == open ? 1 : *at_ == close ? -1 : 0;
    if (depth == 0) {
      ++at_;
      return true;
    }
    if (!text && *at_ == ';') {
      break;
    }
  }
  at_ = end_;
  return refuse(since(word_begin), "unclosed_expression", "a bracket that is not closed");
}

// A known name; at_ is behind it.
bool SinumerikLine::named_value(const char* word_begin, Word& word) {
  const NamedWord& known = *named_word(word.name);
  const char* after_name = at_;
  skip_blanks();
  if (known.index && at_ != end_ && *at_ == '[') {
    if (!pass_brackets(word_begin, '[', ']')) {
      return false;
    }
    after_name = at_;
    skip_blanks();
  } else if (known.brackets && at_ != end_ && *at_ == '(') {
    return pass_brackets(word_begin, '(', ')') && push(word_begin, word);
  }
  if (at_ != end_ && *at_ == '=') {
    ++at_;
    const bool position = equal(word.name, "SPOS") || equal(word.name, "SPOSA");
    return position ? spindle_position(word_begin, word) : assigned(word_begin, word);
  }
  at_ = after_name;
  return push(word_begin, word);
}

// SPOS=90, SPOS=DC(90): the angle of the spindle, and the way to it.
bool SinumerikLine::spindle_position(const char* word_begin, Word& word) {
  skip_blanks();
  const char* const first = at_;
  const std::string_view way = letters();
  const bool known = equal(way, "DC") || equal(way, "ACP") || equal(way, "ACN") ||
                     equal(way, "AC") || equal(way, "IC");
  skip_blanks();
  const bool brackets = known && at_ != end_ && *at_ == '(';
  if (!brackets) {
    at_ = first;
  } else {
    ++at_;
  }
  if (!calculated(word_begin, word.value)) {
    return false;
  }
  if (brackets) {
    if (next() != ')') {
      at_ = end_;
      return refuse(since(word_begin), "unclosed_expression", "a position that is not closed by )");
    }
    ++at_;
  }
  word.has_value = true;
  return push(word_begin, word);
}

// A letter and a number in front of =. Of spindle 1, the master, it is the letter's own word;
// others are names: S2=500, M2=3, I1=10 (the point on the way of CIP). at_ is at the =.
bool SinumerikLine::numbered_address(const char* word_begin, Word& word) {
  word.name = since(word_begin);
  const bool whole = !word.decimal_point && word.value >= 0.0 && word.value <= 99.0 &&
                     word.value == static_cast<double>(static_cast<int>(word.value));
  const bool spindle = word.letter == 'S' || word.letter == 'M';
  const bool way =
      (word.letter == 'I' || word.letter == 'J' || word.letter == 'K') && word.value == 1.0;
  if (whole && word.value == 1.0 && (spindle || word.letter == 'T')) {
    ++at_;
    return assigned(word_begin, word);
  }
  if (whole && (spindle || way)) {
    ++at_;
    word.letter = 0;
    return assigned(word_begin, word);
  }
  const RefusedName* const refused = refused_name(word.name);
  if (refused != nullptr) {
    return refuse(word.name, refused->reason, refused->text);
  }
  while (at_ != end_ && !is_blank(*at_)) {
    ++at_;
  }
  return refuse(since(word_begin), "extended_address",
                "a numbered address (axis or function number) is not supported");
}

// A string as a value of a call. No cycle that is executed takes one: as not a number it is refused
// wherever a cycle uses it.
bool SinumerikLine::string_argument(const char* word_begin) {
  Flow& flow = block_.flow();
  const char* const close = std::find(at_ + 1, end_, '"');
  if (flow.kind == FlowKind::call || close == end_) {
    at_ = end_;
    return refuse(since(word_begin), "subprogram_call", "a string as a call argument");
  }
  at_ = close + 1;
  flow.values[flow.count] = std::numeric_limits<double>::quiet_NaN();
  flow.given |= std::uint32_t{1} << flow.count;
  return true;
}

}  // namespace steadyrest::nc::read
