// SPDX-License-Identifier: Apache-2.0
#include <steadyrest/nc/read/letter_line.hpp>
#include <steadyrest/nc/read/number.hpp>

namespace steadyrest::nc::read {

/// A letter and its number, which nearly all text is: word() without its questions. False, and
/// nothing taken, where it is anything else: word() finds out what.
bool LetterLine::plain_word() noexcept {
  const char* const begin = at_;
  const char letter = upper(*begin);
  if (!is_letter(letter) || letter == 'O' || letter == 'N' ||
      reader_.dialect_ != Dialect::linuxcnc || block_.flow().kind != FlowKind::none) {
    return false;
  }
  const Number number = read_number({begin + 1, static_cast<std::size_t>(end_ - begin) - 1});
  if (number.length == 0) {
    return false;
  }
  const char* const stop = begin + 1 + number.length;
  const char* next = stop;
  while (next != end_ && is_blank(*next)) {
    ++next;
  }
  if (next != end_ && (is_digit(*next) || *next == '.')) {  // a number goes on behind blanks
    return false;
  }
  Word word;
  word.letter = letter;
  word.decimal_point = number.decimal_point;
  word.has_value = true;
  word.value = number.value;
  word.name = {begin, 1};
  word.text = {begin, static_cast<std::size_t>(stop - begin)};
  if (!block_.push(word)) {
    return false;
  }
  at_ = next;
  return true;
}

}  // namespace steadyrest::nc::read
