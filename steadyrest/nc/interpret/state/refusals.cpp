// SPDX-License-Identifier: Apache-2.0
#include <string>

#include <steadyrest/nc/interpret/state/refusals.hpp>

namespace steadyrest::nc::interpret {

using read::Word;

bool Refusals::word(std::uint32_t line, const Word& word, std::string_view reason,
                    std::string_view text) {
  last_ = {.line = line,
           .word = read::printable(word.text.empty() ? word.name : word.text),
           .reason = std::string{reason},
           .text = std::string{text}};
  return false;
}

bool Refusals::letter(const Step& step, char letter, std::string_view reason,
                      std::string_view text) {
  // A decoder may have put a word under another letter (CR= becomes R): then show the block's last
  // word rather than none.
  for (const Word& one : step.block->words()) {
    if (one.letter == letter) {
      return word(step.line, one, reason, text);
    }
  }
  return word(step.line, step.block->words().back(), reason, text);
}

bool Refusals::g_word(const Step& step, int code, std::string_view reason, std::string_view text) {
  for (const Word& one : step.block->words()) {
    if (one.letter == 'G' && g::code_of(one.value) == code) {
      return word(step.line, one, reason, text);
    }
  }
  return block(step, reason, text);
}

bool Refusals::m_word(const Step& step, int number, std::string_view reason,
                      std::string_view text) {
  for (const Word& one : step.block->words()) {
    if (one.letter == 'M' && one.value == number) {
      return word(step.line, one, reason, text);
    }
  }
  return block(step, reason, text);
}

bool Refusals::block(const Step& step, std::string_view reason, std::string_view text) {
  return word(step.line, step.block->words().front(), reason, text);
}

bool Refusals::call(std::uint32_t line, const read::Flow& call, std::string_view reason,
                    std::string_view text) {
  last_ = {.line = line,
           .word = read::printable(call.label.view()),
           .reason = std::string{reason},
           .text = std::string{text}};
  return false;
}

}  // namespace steadyrest::nc::interpret
