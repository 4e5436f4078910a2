// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <string_view>

#include <steadyrest/nc/read/text/block.hpp>
#include <steadyrest/nc/read/text/values.hpp>

namespace steadyrest::nc::read {

/// An O-word of `linuxcnc`: label (`O100`, `O<name>`, `O#1`, `O[…]`), keyword, values.
///
///   sub · endsub [v] · return [v] · call [a] [b] … · if [c] · elseif [c] · else · endif ·
///   while [c] · endwhile · do · repeat [n] · endrepeat · break · continue
///
/// A label without a keyword is the number of a program or subprogram (M98).
class OWord {
 public:
  /// `at` is the position after the letter O. `values` outlives the object.
  OWord(std::string_view line, std::size_t at, const Values& values) noexcept
      : line_(line), begin_(at), at_(at), values_(values) {}

  /// Reads it into `flow`; without `evaluate` only label and keyword. False when it is refused.
  bool read(Flow& flow, bool evaluate);

  [[nodiscard]] std::size_t length() const noexcept { return at_ - begin_; }
  [[nodiscard]] std::string_view reason() const noexcept { return reason_; }
  [[nodiscard]] std::string_view text() const noexcept { return text_; }

 private:
  bool label(Flow& flow);
  bool keyword(Flow& flow);
  bool arguments(Flow& flow);
  bool value(double& out);
  [[nodiscard]] char peek() noexcept;
  bool fail(std::string_view reason, std::string_view text) noexcept;

  std::string_view line_;
  std::size_t begin_;
  std::size_t at_;
  const Values& values_;
  std::string_view reason_;
  std::string_view text_;
};

/// The position after the letter O when the line's first word is an O-word, else 0. A line number
/// and `/` may precede it.
[[nodiscard]] std::size_t o_word_at(std::string_view line) noexcept;

}  // namespace steadyrest::nc::read
