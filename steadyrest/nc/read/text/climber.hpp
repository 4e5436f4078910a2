// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cmath>
#include <cstddef>
#include <string_view>

#include <steadyrest/nc/read/text/character.hpp>
#include <steadyrest/nc/read/text/values.hpp>

namespace steadyrest::nc::read {

/// What a binary operator does; each dialect has some of them.
enum class Operator : unsigned char {
  power,
  times,
  over,
  div,
  modulo,
  plus,
  minus,
  eq,
  ne,
  gt,
  ge,
  lt,
  le,
  both,    ///< AND
  either,  ///< OR
  one,     ///< XOR
  bit_and,
  bit_or,
  bit_xor
};

/// An operator as a dialect writes it, in capitals; `rank` grows with strength.
struct Sign {
  std::string_view name;
  Operator op{};
  int rank = 0;
};

/// What the expressions of all dialects share: a place in a line, the reason for a refusal, and
/// operators of several ranks, each rank from left to right (precedence climbing).
///
/// `Dialect` provides kSigns, a table of its operators; kBlanksWithin, whether their names may
/// contain blanks (else a name ends where the word ends); kClosing, the bracket that closes an
/// expression; operand(out), which reads one operand; apply(op, left, right). Never allocates.
template <class Dialect>
class Climber {
 public:
  /// Where it stopped, in characters after `at`.
  [[nodiscard]] std::size_t length() const noexcept {
    return static_cast<std::size_t>(at_ - begin_);
  }
  [[nodiscard]] std::string_view reason() const noexcept { return reason_; }
  [[nodiscard]] std::string_view text() const noexcept { return text_; }

 protected:
  /// Operands of operators at least as strong as `weakest`.
  bool climb(double& out, int weakest) {
    auto& dialect = static_cast<Dialect&>(*this);
    if (!dialect.operand(out)) {
      return false;
    }
    for (;;) {
      const char* const before = at_;
      const std::size_t found = sign_at();
      if (found == Dialect::kSigns.size() || Dialect::kSigns[found].rank < weakest) {
        at_ = before;
        return true;
      }
      const auto& sign = Dialect::kSigns[found];
      double right = 0.0;
      if (!climb(right, sign.rank + 1) || !dialect.apply(sign.op, out, right)) {
        return false;
      }
    }
  }

  /// Skips the signs here; true when they negate the value.
  [[nodiscard]] bool turned() noexcept {
    bool negative = false;
    for (char c = peek(); c == '+' || c == '-'; c = peek()) {
      negative ^= c == '-';
      ++at_;
    }
    return negative;
  }
  bool fail(std::string_view reason, std::string_view text) noexcept {
    reason_ = reason;
    text_ = text;
    return false;
  }
  bool finite(double value) noexcept {
    return std::isfinite(value) || fail("not_finite", "a calculation without a finite result");
  }
  /// The next character that is not blank, letters as capitals; NUL at the end.
  [[nodiscard]] char peek() noexcept {
    while (at_ != end_ && is_blank(*at_)) {
      ++at_;
    }
    return at_ == end_ ? '\0' : upper(*at_);
  }

  const char* begin_;
  const char* at_;
  const char* end_;
  const Values& values_;
  int depth_ = 0;
  std::string_view reason_;
  std::string_view text_;

 private:
  friend Dialect;
  /// `values` supplies the parameters; both outlive the object.
  Climber(std::string_view line, std::size_t at, const Values& values) noexcept
      : begin_(line.data() + at),
        at_(line.data() + at),
        end_(line.data() + line.size()),
        values_(values) {}

  /// Skips the operator here and returns its index in the table, or the table's size for none.
  std::size_t sign_at() noexcept {
    const char c = peek();
    std::size_t at = c == Dialect::kClosing || c == '\0' ? Dialect::kSigns.size() : 0;
    while (at < Dialect::kSigns.size() &&
           !(Dialect::kSigns[at].name.front() == c && goes_behind(Dialect::kSigns[at].name))) {
      ++at;
    }
    return at;
  }

  bool goes_behind(std::string_view name) noexcept {
    const char* at = at_;
    for (const char wanted : name) {
      while (Dialect::kBlanksWithin && at != end_ && is_blank(*at)) {
        ++at;
      }
      if (at == end_ || upper(*at) != wanted) {
        return false;
      }
      ++at;
    }
    if (!Dialect::kBlanksWithin && is_letter(name.front()) && at != end_ &&
        (is_letter(*at) || is_digit(*at) || *at == '_')) {
      return false;
    }
    at_ = at;
    return true;
  }
};

}  // namespace steadyrest::nc::read
