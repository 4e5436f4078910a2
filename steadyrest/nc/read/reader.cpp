// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <cstddef>
#include <string>

#include <steadyrest/nc/read/letter/letter_line.hpp>
#include <steadyrest/nc/read/letter/o_word.hpp>
#include <steadyrest/nc/read/reader.hpp>
#include <steadyrest/nc/read/sinumerik/sinumerik_line.hpp>
#include <steadyrest/nc/read/text/character.hpp>

namespace steadyrest::nc::read {
namespace {

/// How the lines of a dialect are read.
struct Rules {
  bool (*read)(Reading& reading, std::string_view line, std::uint32_t number, Block& block);
  std::size_t longest;              ///< line, its end included
  bool values_are_numbers;          ///< unless the line says otherwise: see Reader::numbers_alone
  bool percent_closes_unopened;     ///< a program may end with % without having begun with it
  bool archive_name;                ///< its first line may be %_N_NAME, as the control writes it
  bool percent_is_nothing = false;  ///< senders leave lines with % out, wherever they are
  std::size_t most_characters = 0;  ///< of its words; 0 = any number
  bool has_values = true;           ///< `#` and expressions
};

template <const LetterRules& kLetters>
bool read_letters(Reading& reading, std::string_view line, std::uint32_t number, Block& block) {
  return LetterLine(kLetters, reading, line, number, block).read();
}

bool read_sinumerik(Reading& reading, std::string_view line, std::uint32_t number, Block& block) {
  return SinumerikLine(reading, line, number, block).read();
}

// The longest lines: LinuxCNC 2.9 takes 253 characters (measured: 252 and LF are read, one more is
// "Command too long"); the others are ours, far above what the controls store.
constexpr Rules kLinuxcncRules = {read_letters<kLinuxcncLetters>, 253, true, false, false};
constexpr Rules kFanucRules = {read_letters<kFanucLetters>, 1024, false, true, false};
// Senders take out blanks and comments; Grbl 1.1 then has room for 79 characters
// (LINE_BUFFER_SIZE).
constexpr Rules kGrblRules = {read_letters<kGrblLetters>, 1024, true, true, false, true, 79, false};
constexpr Rules kMach3Rules = {read_letters<kMach3Letters>, 1024, true, true, false, true};
constexpr Rules kSinumerikRules = {read_sinumerik, 514, false, true, true};

// A switch, not an array: the compiler names a dialect that is missing here.
constexpr const Rules& rules_of(Dialect dialect) noexcept {
  switch (dialect) {
    case Dialect::fanuc:
    case Dialect::haas:
      return kFanucRules;
    case Dialect::grbl:
      return kGrblRules;
    case Dialect::mach3:
      return kMach3Rules;
    case Dialect::sinumerik:
      return kSinumerikRules;
    case Dialect::linuxcnc:
      break;
  }
  return kLinuxcncRules;
}

// What is left of a line without its blanks and comments.
bool fits(Reading& reading, const Block& block, std::size_t most) {
  std::size_t characters = 0;
  for (const Word& word : block.words()) {
    characters += static_cast<std::size_t>(
        std::ranges::count_if(word.text, [](char c) { return !is_blank(c); }));
  }
  return characters <= most ||
         reading.refuse(block.line(), block.words().front().text, "line_too_long",
                        "a block of " + std::to_string(characters) +
                            " characters without its blanks and comments; Grbl 1.1 has room for " +
                            std::to_string(most));
}

// Blanks and the CR of a line end that was not cut off.
std::string_view trimmed(std::string_view text) noexcept {
  constexpr std::string_view kBlanks = " \t\r";
  const auto first = text.find_first_not_of(kBlanks);
  return first == std::string_view::npos
             ? std::string_view{}
             : text.substr(first, text.find_last_not_of(kBlanks) - first + 1);
}

}  // namespace

void Reader::set_values(Values* values) noexcept {
  reading_.values = rules_of(reading_.dialect).has_values ? values : nullptr;
}

// `%` alone: opens the program in its first line that is not empty, closes it later on.
bool Reader::percent(std::string_view line, std::uint32_t number, Block& block) {
  const std::string_view text = trimmed(line);
  if (text.size() == 1) {
    // The first line that is not empty decides: a program that begins with % ends with %.
    if (!seen_line_) {
      percent_opened_ = true;
      return true;
    }
    if (percent_opened_ || rules_of(reading_.dialect).percent_closes_unopened) {
      block.set_end_mark();
      return true;
    }
    return reading_.refuse(number, text, "misplaced_percent",
                           "% closes a program that did not begin with one");
  }
  return reading_.refuse(number, text, "misplaced_percent",
                         "% must be alone on its line, as the first and last line of the program");
}

// Length, blank lines and % follow the rules above in every dialect; the rest is the dialect's.
bool Reader::read(std::string_view line, std::uint32_t number, std::size_t ending_length,
                  Block& block) {
  // Values are plain numbers until a line shows otherwise: a second run need not read such a line
  // again if it is unchanged.
  block.reset(number);
  reading_.numbers_alone = false;
  const Rules& rules = rules_of(reading_.dialect);
  // A control refuses the line as a whole; reading part of it would be worse than none.
  if (line.size() + ending_length > rules.longest) {
    return reading_.refuse(number, line.substr(0, 16), "line_too_long",
                           "a line of " + std::to_string(line.size()) + " characters; " +
                               std::to_string(rules.longest) +
                               " are allowed in this dialect, line end included");
  }
  // Blank lines are the same in every dialect.
  std::size_t first = 0;
  while (first != line.size() && is_blank(line[first])) {
    ++first;
  }
  if (first == line.size()) {
    return true;
  }
  if (rules.archive_name && number == 1 && line.substr(first).starts_with("%_N_")) {
    return true;
  }
  if (line[first] == '%' && rules.percent_is_nothing) {
    return true;
  }
  if (line[first] == '%') {
    const bool accepted = percent(line, number, block);
    seen_line_ = true;
    return accepted;
  }
  seen_line_ = true;
  reading_.numbers_alone = rules.values_are_numbers;
  const bool accepted =
      rules.read(reading_, line, number, block) &&
      (rules.most_characters == 0 || fits(reading_, block, rules.most_characters));
  reading_.numbers_alone = reading_.numbers_alone && accepted;
  // Assignments act once the whole line is accepted, and not at all in a line left out by block
  // delete.
  if (reading_.values != nullptr && !reading_.numbers_alone) {
    accepted && !(block_delete_ && block.deleted()) ? reading_.values->commit()
                                                    : reading_.values->drop();
  }
  return accepted;
}

// Only where a % closes the program: elsewhere it is an ordinary line.
bool Reader::ends_program(std::string_view line) const noexcept {
  return percent_opened_ && !rules_of(reading_.dialect).percent_closes_unopened &&
         trimmed(line) == "%";
}

bool Reader::read_flow(std::string_view line, std::uint32_t number, Block& block) {
  block.reset(number);
  // Skipped lines: only the O-word, without values.
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
