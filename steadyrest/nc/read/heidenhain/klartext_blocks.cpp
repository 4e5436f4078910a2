// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <cmath>
#include <string>

#include <steadyrest/nc/read/heidenhain/klartext_line.hpp>
#include <steadyrest/nc/read/text/character.hpp>

// The program's frame, tools, labels and calls.
namespace steadyrest::nc::read {
namespace {

std::string_view without_blanks(std::string_view text) noexcept {
  while (!text.empty() && is_blank(text.back())) {
    text.remove_suffix(1);
  }
  while (!text.empty() && is_blank(text.front())) {
    text.remove_prefix(1);
  }
  return text;
}

}  // namespace

// BEGIN PGM name MM: the name may contain blanks, the unit is the last word.
bool KlartextLine::begin_program(const char* word_begin) {
  const bool program = take("PGM");
  const std::string_view text = without_blanks(rest());
  at_ = end_;
  const auto blank = text.find_last_of(" \t");
  const std::string_view unit = text.substr(blank == std::string_view::npos ? 0 : blank + 1);
  const bool mm = std::ranges::equal(unit, std::string_view("MM"), {}, upper);
  if (!program || (!mm && !std::ranges::equal(unit, std::string_view("INCH"), {}, upper))) {
    return refuse(since(word_begin), "begin_unit",
                  "the beginning of a program without its unit; write BEGIN PGM name MM or INCH");
  }
  reading_.begun = true;
  return open(word_begin, Klartext::begin) && named(word_begin, mm ? "MM" : "INCH", 0.0);
}

bool KlartextLine::end_program(const char* word_begin) {
  if (!take("PGM")) {
    return refuse(since(word_begin), "unknown_word", "END is followed by PGM");
  }
  at_ = end_;
  block_.set_end_mark();
  return true;
}

bool KlartextLine::tool(const char* word_begin) {
  const bool definition = take("DEF");
  if (!definition && !take("CALL")) {
    return refuse(since(word_begin), "unknown_word", "TOOL is followed by CALL or DEF");
  }
  if (!open(word_begin, definition ? Klartext::tool_def : Klartext::tool_call)) {
    return false;
  }
  while (!at_end()) {
    if (!tool_words(definition)) {
      return false;
    }
  }
  return true;
}

// TOOL CALL 5 Z S5000 F500 DL+0.1 DR-0.2; TOOL DEF 5 L+12 R+3.
bool KlartextLine::tool_words(bool definition) {
  const char* const word_begin = at_;
  const char c = upper(*at_);
  if (c == '"') {
    const char* const open_quote = ++at_;
    at_ = std::find(at_, end_, '"');
    if (at_ == end_) {
      return refuse(since(word_begin), "unclosed_string", "a name without its closing quote");
    }
    const std::string_view name = since(open_quote);
    ++at_;
    Word* const word = add(word_begin);
    if (word == nullptr) {
      return false;
    }
    word->letter = 'T';
    word->qualifier = Qualifier::text;
    word->text = name;
    return true;
  }
  if (!is_letter(c) || c == 'Q') {
    return is_digit(c) || c == 'Q' ? number_word(word_begin, 'T') : refuse_character();
  }
  const bool axis =
      (c == 'X' || c == 'Y' || c == 'Z') && (at_ + 1 == end_ || is_blank(at_[1]) || at_[1] == ';');
  if (axis && !definition) {
    ++at_;
    return named(word_begin, "AXIS", static_cast<double>(c));
  }
  if (c == 'F' && !definition) {
    return feed_word(word_begin);
  }
  if (c == 'S' && !definition) {
    ++at_;
    return number_word(word_begin, 'S');
  }
  double number = 0.0;
  if (definition && (c == 'L' || c == 'R')) {
    ++at_;
    return value(word_begin, number) &&
           named(word_begin, c == 'L' ? "TOOL LENGTH" : "TOOL RADIUS", number);
  }
  if (c == 'D' && at_ + 1 != end_ && !definition) {
    const bool length = upper(at_[1]) == 'L';
    const bool second = !length && at_ + 2 != end_ && at_[2] == '2';
    if (length || upper(at_[1]) == 'R') {
      at_ += second ? 3 : 2;
      return value(word_begin, number) && named(word_begin,
                                                length   ? "DL"
                                                : second ? "DR2"
                                                         : "DR",
                                                number);
    }
  }
  while (at_ != end_ && !is_blank(*at_)) {
    ++at_;
  }
  return refuse(since(word_begin), "unknown_word", "a word that does not belong to this block");
}

// LBL 5 or LBL "NAME"; LBL 0 ends a subprogram.
bool KlartextLine::label(const char* word_begin) {
  if (!label_name(word_begin)) {
    return false;
  }
  block_.flow().kind = block_.flow().label.view() == "0" ? FlowKind::mark_end : FlowKind::mark;
  return true;
}

// A name keeps its quote, so that LBL "5" is another label than LBL 5.
bool KlartextLine::label_name(const char* word_begin) {
  Name& name = block_.flow().label;
  name.clear();
  skip_blanks();
  if (at_ != end_ && *at_ == '"') {
    const char* const open_quote = at_++;
    at_ = std::find(at_, end_, '"');
    if (at_ == end_) {
      return refuse(since(word_begin), "unclosed_string", "a name without its closing quote");
    }
    const std::string_view text = since(open_quote);
    ++at_;
    return std::ranges::all_of(text, [&](char c) { return name.push(c); }) ||
           refuse(since(word_begin), "bad_label", "a label's name is too long (63 at most)");
  }
  double number = 0.0;
  if (!value(word_begin, number)) {
    return false;
  }
  constexpr double kMostLabels = 65535.0;
  if (number != std::floor(number) || number < 0.0 || number > kMostLabels) {
    return refuse(since(word_begin), "bad_label",
                  "a label is a whole number from 0 to 65535, or a name in quotes");
  }
  for (const char c : std::to_string(static_cast<int>(number))) {
    static_cast<void>(name.push(c));
  }
  return true;
}

bool KlartextLine::call(const char* word_begin) {
  if (take("PGM")) {
    return call_file(word_begin);
  }
  if (!take("LBL")) {
    at_ = end_;
    return refuse(since(word_begin), "unknown_word", "CALL is followed by LBL or PGM");
  }
  Flow& flow = block_.flow();
  if (!label_name(word_begin)) {
    return false;
  }
  flow.count = 0;
  flow.unknown = 0;
  skip_blanks();
  const bool by_parameter =
      end_ - at_ > 3 && upper(at_[3]) == 'Q' &&
      std::ranges::equal(rest().substr(0, 3), std::string_view("REP"), {}, upper);
  at_ += by_parameter ? 3 : 0;  // REPQ5
  if (by_parameter || (take("REP") && !at_end())) {
    double repeats = 0.0;
    if (!value(word_begin, repeats)) {
      return false;
    }
    constexpr double kMostRepeats = 65534.0;
    if (repeats != std::floor(repeats) || repeats < 0.0 || repeats > kMostRepeats) {
      return refuse(since(word_begin), "bad_repeats", "REP takes a whole number from 0 to 65534");
    }
    flow.count = 1;
    flow.values[0] = repeats;
    // REP 5/5: older controls show beside it how many are left.
    skip_blanks();
    if (at_ != end_ && *at_ == '/') {
      ++at_;
      double left = 0.0;
      if (!value(word_begin, left)) {
        return false;
      }
    }
  }
  if (flow.label.view() == "0") {
    return refuse(since(word_begin), "bad_label", "LBL 0 ends subprograms and cannot be called");
  }
  flow.kind = FlowKind::call_mark;
  return true;
}

// CALL PGM TNC:\FOLDER\NAME.H: the name without its folder.
bool KlartextLine::call_file(const char* word_begin) {
  const std::string_view all = without_blanks(rest().substr(0, rest().find(';')));
  const auto slash = all.find_last_of("\\/:");
  const std::string_view text = all.substr(slash == std::string_view::npos ? 0 : slash + 1);
  at_ += rest().substr(0, rest().find(';')).size();
  Flow& flow = block_.flow();
  flow.label.clear();
  if (text.empty() || !std::ranges::all_of(text, [&](char c) { return flow.label.push(c); })) {
    return refuse(since(word_begin), "bad_program_name",
                  "CALL PGM without a program's name of at most 64 characters");
  }
  flow.kind = FlowKind::call_file;
  return true;
}

}  // namespace steadyrest::nc::read
