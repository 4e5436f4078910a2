// SPDX-License-Identifier: Apache-2.0
#include <array>
#include <charconv>
#include <cstdint>
#include <system_error>

#include <steadyrest/nc/read/number.hpp>

namespace steadyrest::nc::read {
namespace {

// Powers of ten that a double holds exactly: a mantissa below 2^53 divided by one of them is
// correctly rounded by the division itself.
constexpr std::array<double, 23> kPowerOfTen = {1e0,  1e1,  1e2,  1e3,  1e4,  1e5,  1e6,  1e7,
                                                1e8,  1e9,  1e10, 1e11, 1e12, 1e13, 1e14, 1e15,
                                                1e16, 1e17, 1e18, 1e19, 1e20, 1e21, 1e22};
constexpr std::uint64_t kExactMantissa = std::uint64_t{1} << 53U;
constexpr int kSafeDigits = 18;  // 10^18 < 2^63

}  // namespace

Number read_number(std::string_view text) noexcept {
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
  int digits = 0;
  for (; at != end && static_cast<unsigned char>(*at - '0') < 10; ++at, ++digits) {
    mantissa = mantissa * 10 + static_cast<std::uint64_t>(*at - '0');
  }
  Number number;
  int decimals = 0;
  if (at != end && *at == '.') {
    number.decimal_point = true;
    ++at;
    const char* const decimals_begin = at;
    for (; at != end && static_cast<unsigned char>(*at - '0') < 10; ++at) {
      mantissa = mantissa * 10 + static_cast<std::uint64_t>(*at - '0');
    }
    decimals = static_cast<int>(at - decimals_begin);
  }
  if (digits + decimals == 0) {
    return {};
  }
  number.length = static_cast<std::size_t>(at - begin);
  if (digits + decimals <= kSafeDigits && mantissa <= kExactMantissa) {
    number.value = static_cast<double>(mantissa) / kPowerOfTen[static_cast<std::size_t>(decimals)];
  } else {
    const auto [stop, error] =
        std::from_chars(digits_begin, at, number.value, std::chars_format::fixed);
    if (error != std::errc{}) {
      return {};
    }
  }
  if (negative) {
    number.value = -number.value;
  }
  return number;
}

}  // namespace steadyrest::nc::read
