// SPDX-License-Identifier: Apache-2.0
#include <string>

#include <steadyrest/nc/read/character.hpp>
#include <steadyrest/nc/read/letter_line.hpp>
#include <steadyrest/nc/read/o_word.hpp>
#include <steadyrest/nc/read/reader.hpp>
#include <steadyrest/nc/read/sinumerik_line.hpp>

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

std::optional<Dialect> dialect_from_name(std::string_view name) noexcept {
  if (name == "linuxcnc") {
    return Dialect::linuxcnc;
  }
  if (name == "fanuc") {
    return Dialect::fanuc;
  }
  if (name == "sinumerik") {
    return Dialect::sinumerik;
  }
  return std::nullopt;
}

std::string_view name(Dialect dialect) noexcept {
  return dialect == Dialect::linuxcnc ? "linuxcnc"
         : dialect == Dialect::fanuc  ? "fanuc"
                                      : "sinumerik";
}

bool Reader::refuse(std::uint32_t line, std::string_view word, std::string_view reason,
                    std::string_view text) {
  refused_ = {.line = line,
              .word = printable(word),
              .reason = std::string{reason},
              .text = std::string{text}};
  return false;
}

// `%` alone: opens the program in its first line that is not empty, closes it after that.
bool Reader::percent(std::string_view line, std::uint32_t number, Block& block) {
  const std::string_view text = trimmed(line);
  if (text.size() == 1) {
    if (!seen_line_) {
      percent_opened_ = true;
      return true;
    }
    if (percent_opened_ || dialect_ != Dialect::linuxcnc) {
      block.set_end_mark();
      return true;
    }
    return refuse(number, text, "misplaced_percent",
                  "% closes a program that did not begin with one");
  }
  return refuse(number, text, "misplaced_percent",
                "% stands alone in its line, as the first and last line of the program");
}

bool Reader::read(std::string_view line, std::uint32_t number, std::size_t ending_length,
                  Block& block) {
  block.reset(number);
  numbers_alone_ = false;
  if (line.size() + ending_length > longest_line(dialect_)) {
    return refuse(number, line.substr(0, 16), "line_too_long",
                  "a line of " + std::to_string(line.size()) + " characters; " +
                      std::to_string(longest_line(dialect_)) +
                      " are allowed in this dialect, line end included");
  }
  std::size_t first = 0;
  while (first != line.size() && is_blank(line[first])) {
    ++first;
  }
  if (first == line.size()) {
    return true;
  }
  if (dialect_ == Dialect::sinumerik && number == 1 && line.substr(first).starts_with("%_N_")) {
    return true;  // the name of the program, as the control writes it into archives
  }
  if (line[first] == '%') {
    const bool accepted = percent(line, number, block);
    seen_line_ = true;
    return accepted;
  }
  seen_line_ = true;
  numbers_alone_ = dialect_ == Dialect::linuxcnc;
  const bool accepted = dialect_ == Dialect::sinumerik
                            ? SinumerikLine(*this, line, number, block).read()
                            : LetterLine(*this, line, number, block).read();
  numbers_alone_ = numbers_alone_ && accepted;
  if (values_ != nullptr && !numbers_alone_) {
    accepted && !(block_delete_ && block.deleted()) ? values_->commit() : values_->drop();
  }
  return accepted;
}

bool Reader::ends_program(std::string_view line) const noexcept {
  return percent_opened_ && dialect_ == Dialect::linuxcnc && trimmed(line) == "%";
}

bool Reader::read_flow(std::string_view line, std::uint32_t number, Block& block) {
  block.reset(number);
  const std::size_t at = o_word_at(line);
  if (at == 0 || values_ == nullptr) {
    return true;
  }
  OWord word(line, at, *values_);
  return word.read(block.flow(), false) ||
         refuse(number, line.substr(at - 1, word.length() + 1), word.reason(), word.text());
}

}  // namespace steadyrest::nc::read
