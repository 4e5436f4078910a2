// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <array>
#include <string>

#include <steadyrest/nc/read/heidenhain/klartext_line.hpp>
#include <steadyrest/nc/read/heidenhain/klartext_value.hpp>
#include <steadyrest/nc/read/text/character.hpp>

// The frame of a line, and which kind of block it is.
namespace steadyrest::nc::read {

bool KlartextLine::read() {
  const char* last = end_;
  while (last != begin_ && (is_blank(last[-1]) || last[-1] == '\r')) {
    --last;
  }
  continues_ = last != begin_ && last[-1] == '~';
  end_ = continues_ ? last - 1 : last;
  const bool accepted = block();
  if (!accepted) {
    reading_.continued = continues_ ? Continued::refused : Continued::no;
  }
  return accepted;
}

bool KlartextLine::block() {
  if (reading_.continued == Continued::refused) {
    return refuse(rest(), "continued_block", "the continuation of a block that is refused");
  }
  if (reading_.continued == Continued::values) {
    return further_values();
  }
  if (reading_.continued == Continued::comment) {
    reading_.continued = continues_ ? Continued::comment : Continued::no;
    return comment();
  }
  skip_blanks();
  if (at_ != end_ && *at_ == '/') {
    block_.set_deleted();
    ++at_;
  }
  if (!block_number()) {
    return false;
  }
  if (at_ == end_ || *at_ == ';' || *at_ == '*') {
    reading_.continued = continues_ ? Continued::comment : Continued::no;
    return comment();
  }
  const char* const word_begin = at_;
  if (!is_letter(*at_)) {
    return refuse_character();
  }
  const std::string_view name = letters();
  if (!reading_.begun && !std::ranges::equal(name, std::string_view("BEGIN"), {}, upper)) {
    return refuse(since(word_begin), "begin_missing",
                  "a block before BEGIN PGM, which gives the unit (MM or INCH)");
  }
  if (!function(word_begin, name)) {
    return false;
  }
  if (continues_ && reading_.continued != Continued::values) {
    // The control breaks long lines as it writes them, mostly within their comment.
    if (at_end() && at_ != end_) {
      reading_.continued = Continued::comment;
      return comment();
    }
    return refuse(since(word_begin), "continued_block",
                  "~ continues only comments and the definition of a cycle (CYCL DEF)");
  }
  return end_of_line();
}

// Block numbers have no effect: labels are what calls and jumps name. Some writers put N before
// them.
bool KlartextLine::block_number() {
  skip_blanks();
  at_ += end_ - at_ >= 2 && upper(*at_) == 'N' && is_digit(at_[1]) ? 1 : 0;
  while (at_ != end_ && is_digit(*at_)) {
    ++at_;
  }
  skip_blanks();
  if (at_ != end_ && *at_ == '/') {
    block_.set_deleted();
    ++at_;
    skip_blanks();
  }
  return true;
}

bool KlartextLine::comment() {
  for (; at_ != end_; ++at_) {
    if (is_control(*at_)) {
      return refuse({at_, 1}, "control_character",
                    "a control character; the file is not text or is damaged");
    }
  }
  return true;
}

// Nothing may be left of the block but a comment.
bool KlartextLine::end_of_line() {
  skip_blanks();
  if (at_ == end_ || *at_ == ';') {
    return comment();
  }
  if (!is_letter(*at_) && !is_digit(*at_) && *at_ != '+' && *at_ != '-') {
    return refuse_character();
  }
  const char* const word_begin = at_;
  while (at_ != end_ && !is_blank(*at_)) {
    ++at_;
  }
  return refuse(since(word_begin), "unknown_word", "a word that does not belong to this block");
}

bool KlartextLine::refuse_character() {
  const std::string_view text = rest();
  const char c = *at_;
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

std::string_view KlartextLine::letters() noexcept {
  const char* const from = at_;
  while (at_ != end_ && is_letter(*at_)) {
    ++at_;
  }
  return since(from);
}

bool KlartextLine::take(std::string_view upper_text) noexcept {
  skip_blanks();
  if (static_cast<std::size_t>(end_ - at_) < upper_text.size() ||
      !std::ranges::equal(rest().substr(0, upper_text.size()), upper_text, {}, upper)) {
    return false;
  }
  const char* const after = at_ + upper_text.size();
  if (after != end_ && is_letter(*after) && is_letter(upper_text.back())) {
    return false;
  }
  at_ = after;
  return true;
}

bool KlartextLine::at_end() noexcept {
  skip_blanks();
  return at_ == end_ || *at_ == ';';
}

Word* KlartextLine::add(const char* word_begin) {
  Word* const word = block_.add();
  if (word == nullptr) {
    refuse(since(word_begin), "too_many_words", "more words than a block may have (128)");
    return nullptr;
  }
  word->letter = 0;
  word->decimal_point = false;
  word->has_value = true;
  word->value = 0.0;
  word->name = since(word_begin);
  word->text = since(word_begin);
  return word;
}

bool KlartextLine::open(const char* word_begin, Klartext function) {
  Word* const word = add(word_begin);
  if (word == nullptr) {
    return false;
  }
  word->value = static_cast<double>(static_cast<int>(function));
  return true;
}

bool KlartextLine::named(const char* word_begin, std::string_view name, double value) {
  Word* const word = add(word_begin);
  if (word == nullptr) {
    return false;
  }
  word->name = name;
  word->value = value;
  return true;
}

bool KlartextLine::path_function(const char* word_begin, std::string_view name, bool& found) {
  struct Path {
    std::string_view name;
    Klartext function;
  };
  static constexpr std::array kPaths = {
      Path{"L", Klartext::line},
      Path{"C", Klartext::circle},
      Path{"CC", Klartext::pole},
      Path{"CR", Klartext::radius_circle},
      Path{"CT", Klartext::tangent_circle},
      Path{"LP", Klartext::polar_line},
      Path{"CP", Klartext::polar_circle},
      Path{"CTP", Klartext::polar_tangent},
      Path{"RND", Klartext::rounding},
      Path{"CHF", Klartext::chamfer},
      Path{"STOP", Klartext::stop},
  };
  const auto* const path = std::ranges::find(kPaths, name, &Path::name);
  found = path != kPaths.end();
  if (!found) {
    return true;
  }
  // The length of a rounding or chamfer is written without an address of its own, or as R.
  if (!open(word_begin, path->function)) {
    return false;
  }
  if (path->function == Klartext::rounding || path->function == Klartext::chamfer) {
    skip_blanks();
    const char* const length_begin = at_;
    if (at_ != end_ && upper(*at_) == 'R') {
      ++at_;
    }
    double length = 0.0;
    if (!value(length_begin, length) || !named(length_begin, "LENGTH", length)) {
      return false;
    }
  }
  return words();
}

// PLANE SPATIAL with three angles of zero.
bool KlartextLine::untilted() noexcept {
  bool zero = take("SPATIAL");
  for (const std::string_view angle : {"SPA", "SPB", "SPC"}) {
    zero = zero && take(angle);
    const Number number = read_klartext_number(rest());
    at_ += number.length;
    zero = zero && number.length != 0 && number.value == 0.0;
  }
  return zero;
}

// PLANE RESET STAY and FUNCTION RESET TCPM end what is refused here: there is nothing to end. A
// plane that is not tilted, without a move of the rotary axes, changes nothing either.
bool KlartextLine::switches_off(std::string_view name) noexcept {
  const char* const from = at_;
  const bool off = (name == "PLANE" && (take("RESET") || untilted()) && take("STAY")) ||
                   (name == "FUNCTION" && take("RESET") && take("TCPM"));
  at_ = from;
  return off;
}

bool KlartextLine::function(const char* word_begin, std::string_view name) {
  std::array<char, 12> capitals{};
  if (name.size() > capitals.size()) {
    return refuse(name, "unknown_word", "a block that begins with an unknown word");
  }
  std::ranges::transform(name, capitals.begin(), upper);
  const std::string_view word{capitals.data(), name.size()};
  bool found = false;
  if (!path_function(word_begin, word, found)) {
    return false;
  }
  if (found) {
    return true;
  }
  if (word == "BLK") {  // the blank's form: for the control's graphics alone
    at_ = end_;
    return true;
  }
  struct Own {
    std::string_view name;
    bool (KlartextLine::*read)(const char* word_begin);
  };
  static constexpr std::array kOwn = {
      Own{"BEGIN", &KlartextLine::begin_program}, Own{"END", &KlartextLine::end_program},
      Own{"TOOL", &KlartextLine::tool},           Own{"LBL", &KlartextLine::label},
      Own{"CALL", &KlartextLine::call},           Own{"CYCL", &KlartextLine::cycle},
      Own{"TRANS", &KlartextLine::datum},         Own{"FN", &KlartextLine::fn},
      Own{"Q", &KlartextLine::assignment},        Own{"QL", &KlartextLine::assignment},
      Own{"QR", &KlartextLine::assignment},
  };
  const auto* const own = std::ranges::find(kOwn, word, &Own::name);
  if (own != kOwn.end()) {
    return (this->*(own->read))(word_begin);
  }
  if (switches_off(word)) {
    at_ = end_;
    return true;
  }
  if (const RefusedFunction* const refused = refused_function(word)) {
    at_ = word_begin + word.size();
    return refuse(since(word_begin), refused->reason, refused->text);
  }
  // M words alone, and an axis alone: "Z+100 R0 FMAX" moves that axis.
  const bool axis = word.size() <= 2 && std::string_view("XYZABUVW").contains(word.back()) &&
                    (word.size() == 1 || word.front() == 'I');
  if (word == "M" || axis) {
    if (axis && !open(word_begin, Klartext::line)) {
      return false;
    }
    at_ = word_begin;
    return words();
  }
  return refuse(name, "unknown_word", "a block that begins with an unknown word");
}

}  // namespace steadyrest::nc::read
