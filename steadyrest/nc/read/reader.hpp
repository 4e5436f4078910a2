// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <string_view>

#include <steadyrest/nc/read/text/block.hpp>
#include <steadyrest/nc/read/text/reading.hpp>

namespace steadyrest::nc::read {

/// Splits the lines of one program into words. Knows characters, comments and numbers; what a word
/// means is the interpreter's business.
///
/// Deterministic; allocates only when it refuses a line. After a refusal it can read the next line.
class Reader {
 public:
  explicit Reader(Dialect dialect) noexcept : reading_{.dialect = dialect} {}

  /// Reads one line (without its end) into `block`. False when it is refused: see `refused()`.
  /// The block refers to the line's characters: keep them while it is in use.
  bool read(std::string_view line, std::uint32_t number, std::size_t ending_length, Block& block);

  /// Takes over the words of the same line, which `other` has just read from another text. False
  /// when the line must be read: only plain numbers are independent of what the program did before.
  bool take(const Reader& other, const Block& read, std::uint32_t number, Block& block) noexcept {
    if (!other.reading_.numbers_alone || reading_.dialect != other.reading_.dialect) {
      return false;
    }
    block.reset(number);
    block.take_words(read);
    seen_line_ = true;
    reading_.numbers_alone = true;
    return true;
  }

  /// Reads only the O-word of a skipped line, label and keyword; evaluates nothing but the label.
  /// False when that is refused.
  bool read_flow(std::string_view line, std::uint32_t number, Block& block);

  /// A skipped line is the `%` that closes the program: the search ends there.
  [[nodiscard]] bool ends_program(std::string_view line) const noexcept;

  /// What expressions read and assignments set; nullptr: expressions are refused. Must outlive the
  /// reading.
  void set_values(Values* values) noexcept;

  /// The same for sinumerik, whose variables have types.
  void set_typed_values(TypedValues* values) noexcept {
    reading_.values = reading_.typed_values = values;
  }
  /// Lines that begin with / are left out: their assignments are dropped.
  void set_block_delete(bool on) noexcept { block_delete_ = on; }

  [[nodiscard]] const Refused& refused() const noexcept { return reading_.refused; }
  /// The last line was read, and no value was asked for or set.
  [[nodiscard]] bool numbers_alone() const noexcept { return reading_.numbers_alone; }
  /// The program began with `%`: it must end with one (or with its end word).
  [[nodiscard]] bool percent_opened() const noexcept { return percent_opened_; }

 private:
  bool percent(std::string_view line, std::uint32_t number, Block& block);

  Reading reading_;
  bool block_delete_ = false;
  bool seen_line_ = false;
  bool percent_opened_ = false;
};

}  // namespace steadyrest::nc::read
