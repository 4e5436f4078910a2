// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include <steadyrest/kernel/outcome/result.hpp>

/// The lines, words and numbers of a universal file: Fortran records of 80 columns, with blocks of
/// bytes between them in binary datasets.
namespace steadyrest::chatter::offline {

class UffLines {
 public:
  UffLines(std::string_view text, const std::string& file) : rest_(text), file_(file) {}

  /// Goes to the next line; false at the end.
  bool next();
  /// To the −1 that ends a dataset; false if there is none.
  bool pass_over();
  /// Whether a −1 in its columns follows `count` bytes, behind line ends at most.
  [[nodiscard]] bool ends_after(std::size_t count) const;
  /// The next `count` bytes; there are as many.
  std::string_view bytes(std::size_t count);

  [[nodiscard]] std::string_view line() const noexcept { return line_; }
  [[nodiscard]] std::size_t number() const noexcept { return at_; }
  [[nodiscard]] std::size_t left() const noexcept { return rest_.size(); }
  [[nodiscard]] bool is_delimiter() const;

  [[nodiscard]] kernel::outcome::Refusal bad(std::string what, std::string to_do) const;
  [[nodiscard]] kernel::outcome::Refusal truncated() const;

 private:
  std::string_view rest_;
  std::string_view line_;
  std::size_t at_ = 0;
  const std::string& file_;
};

/// Whether a text is a universal file: its first line, behind blank ones, has −1 in columns 5 and 6
/// and nothing else.
[[nodiscard]] bool is_universal(std::string_view text);

[[nodiscard]] std::string_view uff_trimmed(std::string_view text);
/// The blank-separated words of a line.
[[nodiscard]] std::vector<std::string_view> uff_words(std::string_view line);
/// The columns `at` … `at + size` of a record, without blanks around.
[[nodiscard]] std::string_view uff_columns(std::string_view line, std::size_t at, std::size_t size);
/// A finite number; Fortran writes 1.0D+00 as well.
[[nodiscard]] std::optional<double> uff_number(std::string_view word);
/// A whole number of up to nine digits.
[[nodiscard]] std::optional<long> uff_whole(std::string_view word);

}  // namespace steadyrest::chatter::offline
