// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <bit>
#include <cstddef>
#include <cstdint>
#include <string>

#include <steadyrest/nc/interpret/state/refusals.hpp>
#include <steadyrest/nc/read/text/character.hpp>

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
  // First the words under another name: with CR= the block's own R would be another word.
  if ((step.renamed_letters & Step::bit(letter)) != 0) {
    return word(step.line,
                step.block->words()[step.letter_from[static_cast<std::size_t>(letter - 'A')]],
                reason, text);
  }
  for (const Word& one : step.block->words()) {
    if (one.letter == letter) {
      return word(step.line, one, reason, text);
    }
  }
  return word(step.line, step.block->words().back(), reason, text);
}

bool Refusals::g_word(const Step& step, int code, std::string_view reason, std::string_view text) {
  for (std::uint32_t left = step.renamed_groups; left != 0; left &= left - 1) {
    const auto group = static_cast<std::size_t>(std::countr_zero(left));
    if (step.g[group] == code) {
      return word(step.line, step.block->words()[step.group_from[group]], reason, text);
    }
  }
  for (const Word& one : step.block->words()) {
    if (one.letter == 'G' && g::code_of(one.value) == code) {
      return word(step.line, one, reason, text);
    }
  }
  // sinumerik: machine coordinates by another word.
  return code == g::kMachineFrame ? named(step, "SUPA", reason, text) : block(step, reason, text);
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

bool Refusals::named(const Step& step, std::string_view name, std::string_view reason,
                     std::string_view text) {
  for (const Word& one : step.block->words()) {
    if (std::ranges::equal(one.name, name, {}, read::upper)) {
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
