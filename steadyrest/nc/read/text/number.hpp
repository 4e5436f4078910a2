// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <bit>
#include <cstddef>
#include <cstdint>
#include <cstring>
#include <string_view>

namespace steadyrest::nc::read {

/// A number at the head of a text.
struct Number {
  double value = 0.0;
  std::size_t length = 0;  ///< characters taken; 0 = there is no number here
  bool decimal_point = false;
};

/// read_number() for digits that do not fit a mantissa that a double holds exactly.
[[nodiscard]] bool read_long_number(const char* begin, const char* end, double& value) noexcept;

namespace detail {

// Powers of ten that a double holds exactly: a mantissa below 2^53 divided by one of them is
// correctly rounded by the division itself.
inline constexpr std::array<double, 19> kPowerOfTen = {1e0,  1e1,  1e2,  1e3,  1e4,  1e5,  1e6,
                                                       1e7,  1e8,  1e9,  1e10, 1e11, 1e12, 1e13,
                                                       1e14, 1e15, 1e16, 1e17, 1e18};
inline constexpr std::array<std::uint64_t, 9> kWholePowerOfTen = {
    1, 10, 100, 1000, 10000, 100000, 1000000, 10000000, 100000000};
inline constexpr std::uint64_t kExactMantissa = std::uint64_t{1} << 53U;
inline constexpr int kSafeDigits = 18;  // 10^18 < 2^63

/// Eight digits, one a byte, the first in the lowest: pairs, then fours, then all of them.
[[nodiscard]] constexpr std::uint64_t eight_digits(std::uint64_t bytes) noexcept {
  constexpr std::uint64_t kPair = 0x000000ff000000ff;
  bytes = bytes * 10 + (bytes >> 8U);
  return ((bytes & kPair) * ((std::uint64_t{1000000} << 32U) + 100) +
          ((bytes >> 16U) & kPair) * ((std::uint64_t{10000} << 32U) + 1)) >>
         32U;
}

/// Appends the digits from `at` on to the mantissa, eight at a time; returns what follows.
[[nodiscard]] inline const char* take_digits(const char* at, const char* end,
                                             std::uint64_t& mantissa) noexcept {
  if constexpr (std::endian::native == std::endian::little) {
    constexpr std::uint64_t kZeros = 0x3030303030303030;
    constexpr std::uint64_t kLow = 0x7f7f7f7f7f7f7f7f;
    constexpr std::uint64_t kAboveNine = 0x7676767676767676;  // 0x80 − 10
    while (end - at >= 8) {
      std::uint64_t bytes = 0;
      std::memcpy(&bytes, at, sizeof bytes);
      bytes ^= kZeros;
      const std::uint64_t others = (((bytes & kLow) + kAboveNine) | bytes) & ~kLow;
      if (others == 0) {
        mantissa = mantissa * kWholePowerOfTen[8] + eight_digits(bytes);
        at += 8;
        continue;
      }
      const auto count = static_cast<unsigned>(std::countr_zero(others)) / 8U;
      if (count == 0) {
        return at;
      }
      mantissa = mantissa * kWholePowerOfTen[count] + eight_digits(bytes << (64U - 8U * count));
      return at + count;
    }
  }
  for (; at != end && static_cast<unsigned char>(*at - '0') < 10; ++at) {
    mantissa = mantissa * 10 + static_cast<std::uint64_t>(*at - '0');
  }
  return at;
}

}  // namespace detail

/// Reads `[+-]digits[.digits]`, correctly rounded (the nearest double, as the C library gives).
///
/// At least one digit; no exponent: `E` is a word of its own in NC programs. Bounded by the text;
/// never allocates. A number too large for a double is not read: length 0.
[[nodiscard]] inline Number read_number(std::string_view text) noexcept {
  const char* const begin = text.data();
  const char* const end = begin + text.size();
  const char* at = begin;
  bool negative = false;
  if (at != end && (*at == '-' || *at == '+')) {
    negative = *at == '-';
    ++at;
  }
  const char* const digits_begin = at;
  std::uint64_t mantissa = 0;
  for (; at != end && static_cast<unsigned char>(*at - '0') < 10; ++at) {  // few, mostly
    mantissa = mantissa * 10 + static_cast<std::uint64_t>(*at - '0');
  }
  auto digits = at - digits_begin;
  Number number;
  std::ptrdiff_t decimals = 0;
  if (at != end && *at == '.') {
    number.decimal_point = true;
    const char* const decimals_begin = ++at;
    at = detail::take_digits(at, end, mantissa);
    decimals = at - decimals_begin;
    digits += decimals;
  }
  if (digits == 0) {
    return {};
  }
  number.length = static_cast<std::size_t>(at - begin);
  if (digits <= detail::kSafeDigits && mantissa <= detail::kExactMantissa) {
    number.value = static_cast<double>(static_cast<std::int64_t>(mantissa)) /
                   detail::kPowerOfTen[static_cast<std::size_t>(decimals)];
  } else if (!read_long_number(digits_begin, at, number.value)) {
    return {};
  }
  if (negative) {
    number.value = -number.value;
  }
  return number;
}

}  // namespace steadyrest::nc::read
