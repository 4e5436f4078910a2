// SPDX-License-Identifier: Apache-2.0
#include <string>

#include <steadyrest/nc/read/letter/letter_line.hpp>
#include <steadyrest/nc/read/letter/o_word.hpp>
#include <steadyrest/nc/read/reader.hpp>
#include <steadyrest/nc/read/sinumerik/sinumerik_line.hpp>
#include <steadyrest/nc/read/text/character.hpp>

namespace steadyrest::nc::read {
namespace {

// The longest lines, line end included: LinuxCNC 2.9 takes 253 characters (measured: 252 and LF are
// read, one more is "Command too long"); the others are ours, far above what the controls store.
constexpr std::size_t longest_line(Dialect dialect) noexcept {
  return dialect == Dialect::linuxcnc ? 253 : dialect == Dialect::sinumerik ? 514 : 1024;
}

std::string_view trimmed(std::string_view text) noexcept {
  constexpr std::string_view kBlanks = " \t\r";
  const auto first = text.find_first_not_of(kBlanks);
  return first == std::string_view::npos
             ? std::string_view{}
             : text.substr(first, text.find_last_not_of(kBlanks) - first + 1);
}

}  // namespace

// `%` alone: opens the program in its first line that is not empty, closes it after that.
bool Reader::percent(std::string_view line, std::uint32_t number, Block& block) {
  const std::string_view text = trimmed(line);
  if (text.size() == 1) {
    if (!seen_line_) {
      percent_opened_ = true;
      return true;
    }
    if (percent_opened_ || reading_.dialect != Dialect::linuxcnc) {
      block.set_end_mark();
      return true;
    }
    return reading_.refuse(number, text, "misplaced_percent",
                           "% closes a program that did not begin with one");
  }
  return reading_.refuse(number, text, "misplaced_percent",
                         "% must be alone on its line, as the first and last line of the program");
}

bool Reader::read(std::string_view line, std::uint32_t number, std::size_t ending_length,
                  Block& block) {
  block.reset(number);
  reading_.numbers_alone = false;
  if (line.size() + ending_length > longest_line(reading_.dialect)) {
    return reading_.refuse(number, line.substr(0, 16), "line_too_long",
                           "a line of " + std::to_string(line.size()) + " characters; " +
                               std::to_string(longest_line(reading_.dialect)) +
                               " are allowed in this dialect, line end included");
  }
  std::size_t first = 0;
  while (first != line.size() && is_blank(line[first])) {
    ++first;
  }
  if (first == line.size()) {
    return true;
  }
  if (reading_.dialect == Dialect::sinumerik && number == 1 &&
      line.substr(first).starts_with("%_N_")) {
    return true;  // the name of the program, as the control writes it into archives
  }
  if (line[first] == '%') {
    const bool accepted = percent(line, number, block);
    seen_line_ = true;
    return accepted;
  }
  seen_line_ = true;
  reading_.numbers_alone = reading_.dialect == Dialect::linuxcnc;
  const bool accepted = reading_.dialect == Dialect::sinumerik
                            ? SinumerikLine(reading_, line, number, block).read()
                            : LetterLine(reading_, line, number, block).read();
  reading_.numbers_alone = reading_.numbers_alone && accepted;
  if (reading_.values != nullptr && !reading_.numbers_alone) {
    accepted && !(block_delete_ && block.deleted()) ? reading_.values->commit()
                                                    : reading_.values->drop();
  }
  return accepted;
}

bool Reader::ends_program(std::string_view line) const noexcept {
  return percent_opened_ && reading_.dialect == Dialect::linuxcnc && trimmed(line) == "%";
}

bool Reader::read_flow(std::string_view line, std::uint32_t number, Block& block) {
  block.reset(number);
  const std::size_t at = o_word_at(line);
  if (at == 0 || reading_.values == nullptr) {
    return true;
  }
  OWord word(line, at, *reading_.values);
  return word.read(block.flow(), false) ||
         reading_.refuse(number, line.substr(at - 1, word.length() + 1), word.reason(),
                         word.text());
}

}  // namespace steadyrest::nc::read
