// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <bit>
#include <cstddef>
#include <cstdint>
#include <cstring>

#include <steadyrest/nc/read/text/number.hpp>

namespace steadyrest::nc::read {
namespace detail {

/// A run of at most seven digits.
struct Digits {
  std::uint64_t value = 0;
  unsigned count = 0;  ///< 8: there may be more
};

/// The digits at `at`, eight bytes at once: no branch depends on their number. The text must have
/// at least eight bytes before `end`.
[[nodiscard]] inline Digits few_digits(const char* at, const char* end) noexcept {
  constexpr std::uint64_t kZeros = 0x3030303030303030;
  constexpr std::uint64_t kLow = 0x7f7f7f7f7f7f7f7f;
  constexpr std::uint64_t kAboveNine = 0x7676767676767676;  // 0x80 − 10
  std::uint64_t bytes = 0;
  const auto rest = static_cast<std::size_t>(end - at);
  if (rest >= sizeof bytes) {
    std::memcpy(&bytes, at, sizeof bytes);
  } else {  // the last eight; those before `at` are shifted out, twice by half
    std::memcpy(&bytes, end - sizeof bytes, sizeof bytes);
    const auto half = static_cast<unsigned>(4 * (sizeof bytes - rest));
    bytes = bytes >> half >> half;
  }
  bytes ^= kZeros;
  const std::uint64_t others = (((bytes & kLow) + kAboveNine) | bytes) & ~kLow;
  const auto count = static_cast<unsigned>(std::countr_zero(others)) / 8U;
  if (count == 8) {
    return {.value = 0, .count = 8};
  }
  const unsigned half = 4U * (8U - count);
  return {.value = eight_digits(bytes << half << half), .count = count};
}

}  // namespace detail

/// Reads like read_number() a number with at most seven digits on either side of the point.
/// Anything else returns false and leaves `number` unchanged. `begin` is the start of the text that
/// `at` points into.
[[nodiscard]] inline bool read_short_number(const char* begin, const char* at, const char* end,
                                            Number& number) noexcept {
  if constexpr (std::endian::native != std::endian::little) {
    return false;
  }
  if (end - begin < 8 || at == end) {
    return false;
  }
  const char* const first = at;
  const auto negative = static_cast<std::uint64_t>(*at == '-');
  at += negative | static_cast<std::uint64_t>(*at == '+');  // no branch: signs are unpredictable
  const detail::Digits whole = detail::few_digits(at, end);
  at += whole.count;
  detail::Digits decimals;
  const bool point = at < end && *at == '.';
  if (point) {
    decimals = detail::few_digits(++at, end);
    at += decimals.count;
  }
  if (whole.count == 8 || decimals.count == 8 || whole.count + decimals.count == 0) {
    return false;
  }
  const auto mantissa = static_cast<std::int64_t>(
      whole.value * detail::kWholePowerOfTen[decimals.count] + decimals.value);
  const double value = static_cast<double>(mantissa) / detail::kPowerOfTen[decimals.count];
  constexpr unsigned kSignBit = 63;
  number.value =
      std::bit_cast<double>(std::bit_cast<std::uint64_t>(value) | (negative << kSignBit));
  number.length = static_cast<std::size_t>(at - first);
  number.decimal_point = point;
  return true;
}

}  // namespace steadyrest::nc::read
