// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <string_view>

namespace steadyrest::nc::read {

/// A number at the head of a text.
struct Number {
  double value = 0.0;
  std::size_t length = 0;  ///< characters taken; 0 = there is no number here
  bool decimal_point = false;
};

/// Reads `[+-]digits[.digits]`, correctly rounded (the nearest double, as the C library gives).
///
/// At least one digit; no exponent: `E` is a word of its own in NC programs. Bounded by the text;
/// never allocates. A number whose magnitude exceeds every double is not a number: length 0.
[[nodiscard]] Number read_number(std::string_view text) noexcept;

}  // namespace steadyrest::nc::read
