// SPDX-License-Identifier: Apache-2.0
#include <array>

#include <steadyrest/nc/read/letter/letter_line.hpp>
#include <steadyrest/nc/read/text/short_number.hpp>

namespace steadyrest::nc::read {
namespace {

constexpr std::size_t kCharacters = 256;

/// The capitals of the letters that begin a plain word: all but N and O; else 0. N is the line
/// number and O an O-word: both are more than a letter with a number.
constexpr std::array<char, kCharacters> plain_letters() {
  std::array<char, kCharacters> out{};
  for (char c = 'A'; c <= 'Z'; ++c) {
    if (c != 'N' && c != 'O') {
      out[static_cast<unsigned char>(c)] = c;
      out[static_cast<unsigned char>(c) | 0x20U] = c;
    }
  }
  return out;
}

// A table of 256 answers three questions at once: is it a letter, is it plain, what is its capital.
constexpr std::array<char, kCharacters> kPlainLetter = plain_letters();

}  // namespace

/// Letters and their numbers, nearly all of any program: word() without its checks. Stops before
/// anything else, which is left to one_item() and word().
void LetterLine::plain_words() noexcept {
  if (!rules_.plain_words_fast || block_.flow().kind != FlowKind::none) {
    return;
  }
  const char* at = at_;
  while (at != end_) {
    const char letter = kPlainLetter[static_cast<unsigned char>(*at)];
    if (letter == 0) {
      break;
    }
    Number number;
    // One digit and a blank, as in G0 and G1, by far the most common words.
    if (end_ - at > 3 && at[2] == ' ' && is_digit(at[1]) && is_letter(at[3])) {  // `G1 X…`
      number = {.value = static_cast<double>(at[1] - '0'), .length = 1, .decimal_point = false};
    } else if (!read_short_number(begin_, at + 1, end_, number)) {
      number = read_number({at + 1, static_cast<std::size_t>(end_ - at) - 1});
      if (number.length == 0) {
        break;
      }
    }
    const char* const stop = at + 1 + number.length;
    const char* next = stop;
    while (next != end_ && is_blank(*next)) {
      ++next;
    }
    // `X1 2` is X12 in this dialect: the slow path joins it.
    if (next != end_ && (is_digit(*next) || *next == '.')) {  // a number continues after blanks
      break;
    }
    Word* const word = block_.add();
    // More words than a block has room for: the slow path refuses with a text.
    if (word == nullptr) {
      break;
    }
    word->letter = letter;
    word->decimal_point = number.decimal_point;
    word->has_value = true;
    word->value = number.value;
    word->name = {at, 1};
    word->text = {at, static_cast<std::size_t>(stop - at)};
    at = next;
  }
  at_ = at;
}

}  // namespace steadyrest::nc::read
