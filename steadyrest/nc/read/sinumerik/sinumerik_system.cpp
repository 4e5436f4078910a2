// SPDX-License-Identifier: Apache-2.0
#include <string_view>

#include <steadyrest/nc/read/sinumerik/sinumerik_line.hpp>
#include <steadyrest/nc/read/sinumerik/sinumerik_names.hpp>
#include <steadyrest/nc/read/text/character.hpp>

// System variables that a program may write: corrections of an axis here, frames and tool data in
// sinumerik_frame.cpp. Anything else that begins with $ is refused by name.
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
  if (take("$P_UIFR") || take("$P_PFRAME")) {
    return stored_offset(word_begin);
  }
  if (take("$TC_")) {
    return tool_data(word_begin);
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

}  // namespace steadyrest::nc::read
