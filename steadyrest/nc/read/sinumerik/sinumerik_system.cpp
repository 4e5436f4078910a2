// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>
#include <cstddef>
#include <string>
#include <string_view>

#include <steadyrest/nc/read/sinumerik/sinumerik_expression.hpp>
#include <steadyrest/nc/read/sinumerik/sinumerik_line.hpp>
#include <steadyrest/nc/read/sinumerik/sinumerik_names.hpp>
#include <steadyrest/nc/read/text/character.hpp>

// The two system variables that a program may write: corrections of an axis. Anything else that
// begins with $ is refused by name.
namespace steadyrest::nc::read {

/// Takes `upper_text` and any blanks before it: blanks may separate the parts of these names.
bool SinumerikLine::take(std::string_view upper_text) {
  skip_blanks();
  if (!equal(rest().substr(0, upper_text.size()), upper_text)) {
    return false;
  }
  at_ += upper_text.size();
  return true;
}

// Axes by their letter only: names such as Z1 and indices such as AX3 depend on the machine.
bool SinumerikLine::axis_letter(char& letter) {
  constexpr std::string_view kAxes = "XYZABCUVW";
  skip_blanks();
  if (at_ == end_ || kAxes.find(upper(*at_)) == std::string_view::npos) {
    return false;
  }
  letter = upper(*at_++);
  return true;
}

bool SinumerikLine::system_variable(const char* word_begin) {
  // On the control such an assignment may share a block, but the order of execution is not certain.
  if (!block_.words().empty() || assigned_ || block_.flow().kind != FlowKind::none) {
    return refuse_character();
  }
  // The temperature compensation of an axis: the machine moves, its programmed positions do not.
  if (take("$SA_TEMP_COMP_ABS_VALUE")) {
    char axis = 0;
    double value = 0.0;
    if (!take("[") || !axis_letter(axis) || !take("]") || !take("=")) {
      at_ = end_;
      return refuse(since(word_begin), "parameter",
                    "write $SA_TEMP_COMP_ABS_VALUE[Z]=value, with the letter of an axis");
    }
    // The value is read and checked, but no position of the program changes.
    return calculated(word_begin, value) && assign(word_begin, Lookup::found);
  }
  return take("$P_IFRAME") ? fine_offset(word_begin) : refuse_character();
}

// $P_IFRAME[Z,FI]=$P_UIFR[$P_UIFRNUM,Z,FI]-0.01: the fine offset of the active settable frame is
// the stored one plus this much. The stored one is not known here, so no other form is read.
bool SinumerikLine::fine_offset(const char* word_begin) {
  Word word;
  char stored = 0;
  // The whole form, part by part, as `rewrite` writes it.
  const bool read = take("[") && axis_letter(word.letter) && take(",") && take("FI") && take("]") &&
                    take("=") && take("$P_UIFR") && take("[") && take("$P_UIFRNUM") && take(",") &&
                    axis_letter(stored) && take(",") && take("FI") && take("]") &&
                    stored == word.letter;
  // Without a sign only the stored offset applies: the correction is off.
  const char sign = read ? next() : '\0';
  if (!read || (sign != '\0' && sign != '+' && sign != '-')) {
    at_ = end_;
    return refuse(since(word_begin), "parameter",
                  "write a frame only as $P_IFRAME[Z,FI]=$P_UIFR[$P_UIFRNUM,Z,FI]+value");
  }
  at_ += sign == '+' ? 1 : 0;
  // `-` stays in front of the value: the expression reads it as its sign.
  if (sign != '\0' && !calculated(word_begin, word.value)) {
    return false;
  }
  word.qualifier = Qualifier::fine;
  word.has_value = true;
  const bool pushed = push(word_begin, word);
  // Counts as an assignment: nothing else may share the block.
  assigned_ = true;
  return pushed;
}

// $P_EP[X], $AA_IW[X], $A_IN[1], $P_TOOLNO: what they mean is the variables' business. An index is
// the name of an axis, or a number, which becomes part of the name.
bool SinumerikExpression::system_variable(double& out) {
  Name name;
  bool fits = name.push('$');
  for (++at_; at_ != end_ && in_name(*at_); ++at_) {
    fits = fits && name.push(upper(*at_));
  }
  char axis = 0;
  if (peek() == '[') {
    ++at_;
    if (++depth_ > kDeepest) {
      return fail("expression_too_deep", "brackets nested more than 64 deep");
    }
    constexpr std::string_view kAxes = "XYZABCUVW";
    const char c = peek();
    if (kAxes.find(c) != std::string_view::npos && at_ + 1 != end_ && !in_name(at_[1])) {
      axis = c;
      ++at_;
    } else {
      double index = 0.0;
      if (!climb(index, 0)) {
        return false;
      }
      if (index != std::floor(index) || index < 0.0 || index > 99999.0) {
        return fail("system_variable",
                    "a system variable with an index that is no axis letter "
                    "and not a whole number");
      }
      std::array<char, 8> digits{};
      const auto* const end =
          std::to_chars(digits.begin(), digits.end(), static_cast<int>(index)).ptr;
      fits = fits && name.push('[');
      for (const char* digit = digits.begin(); digit != end; ++digit) {
        fits = fits && name.push(*digit);
      }
      fits = fits && name.push(']');
    }
    if (!closing(']')) {
      return false;
    }
  }
  const Lookup lookup =
      fits && typed_ != nullptr ? typed_->system(name.view(), axis, out) : Lookup::not_known_here;
  return lookup == Lookup::found ||
         fail("system_variable", "a system variable ($...) whose meaning is not known here");
}

// A[R1,2]: the variable whose name has the indices.
bool SinumerikExpression::element(double& out, Name& name) {
  if (++depth_ > kDeepest) {
    return fail("expression_too_deep", "brackets nested more than 64 deep");
  }
  char before = '[';
  do {
    ++at_;
    double index = 0.0;
    if (!climb(index, 0)) {
      return false;
    }
    std::array<char, 8> digits{};
    const bool whole = index == std::floor(index) && index >= 0.0 && index < 1e6;
    const auto* const end =
        std::to_chars(digits.begin(), digits.end(), whole ? static_cast<int>(index) : 0).ptr;
    bool fits = whole && name.push(before);
    for (const char* digit = digits.begin(); digit != end; ++digit) {
      fits = fits && name.push(*digit);
    }
    if (!fits) {
      return fail("array", "an index that is not a whole number from 0");
    }
    before = ',';
  } while (peek() == ',');
  if (!closing(']') || !name.push(']')) {
    return false;
  }
  const Lookup lookup = values_.name(name.view(), out);
  return lookup == Lookup::no_such_name
             ? fail("variable", "an array, or an element of it, not defined (DEF) in this program")
             : looked_up(lookup);
}

// "TOP"==NAME, NAME<>"TOP": case counts. A single character is also a number, that of its code.
bool SinumerikExpression::text_comparison(double& out) {
  const auto text = [this](std::string_view& read) {
    const char* const from = at_;
    if (peek() == '"') {
      const char* const open = ++at_;
      while (at_ != end_ && *at_ != '"') {
        ++at_;
      }
      if (at_ == end_) {
        return fail("unclosed_string", "a string without its closing quote");
      }
      read = {open, static_cast<std::size_t>(at_++ - open)};
      return true;
    }
    Name name;
    bool fits = true;
    while (at_ != end_ && in_name(*at_)) {
      fits = name.push(lower(*at_++)) && fits;
    }
    const std::string* const found = fits ? typed_->text(name.view()) : nullptr;
    if (found == nullptr) {
      at_ = from;
      return false;
    }
    read = *found;
    return true;
  };
  std::string_view left;
  std::string_view right;
  if (!text(left)) {
    return reason_.empty() ? fail("bad_value", "a string belongs here") : false;
  }
  while (at_ != end_ && is_blank(*at_)) {
    ++at_;
  }
  const std::string_view how{at_,
                             static_cast<std::size_t>(std::min<std::ptrdiff_t>(2, end_ - at_))};
  if (how != "==" && how != "<>") {
    out = left.size() == 1 ? static_cast<double>(static_cast<unsigned char>(left.front())) : 0.0;
    return left.size() == 1 || fail("bad_value", "a string where a number belongs");
  }
  const char* const operation = at_;
  at_ += 2;
  if (!text(right)) {
    if (left.size() == 1 && reason_.empty()) {  // a character beside a number
      at_ = operation;
      out = static_cast<double>(static_cast<unsigned char>(left.front()));
      return true;
    }
    return reason_.empty() ? fail("bad_value", "a string is compared with strings only") : false;
  }
  out = (left == right) == (how == "==") ? 1.0 : 0.0;
  return true;
}

}  // namespace steadyrest::nc::read
