// SPDX-License-Identifier: Apache-2.0
#include <bit>
#include <cstdint>
#include <cstdlib>
#include <string>
#include <string_view>

#include <gtest/gtest.h>
#include <rapidcheck.h>

#include <steadyrest/nc/read/text/number.hpp>
#include <steadyrest/nc/read/text/short_number.hpp>

namespace steadyrest::nc::read {
namespace {

// The C library's conversion is the oracle: correctly rounded for any number of digits.
TEST(Number, IsTheDoubleThatTheCLibraryGives) {
  EXPECT_TRUE(rc::check([] {
    const auto digits = *rc::gen::inRange(1, 25);
    const auto decimals = *rc::gen::inRange(0, 25);
    std::string text = *rc::gen::element<std::string>("", "-", "+");
    for (int i = 0; i < digits + decimals; ++i) {
      text += i == digits ? "." : "";
      text += static_cast<char>('0' + *rc::gen::inRange(0, 10));
    }
    const Number number = read_number(text);
    RC_ASSERT(number.length == text.size());
    RC_ASSERT(number.value == std::strtod(text.c_str(), nullptr));
  }));
}

// Bit for bit, −0 included, against the long way. Text before and after the number shows a read
// beyond either end.
TEST(Number, IsTheSameTheShortWay) {
  EXPECT_TRUE(rc::check([] {
    const std::string signs = *rc::gen::element<std::string>("", "-", "+", "--", "X");
    const auto of_length = [](std::size_t most) {
      return *rc::gen::resize(
          static_cast<int>(most),
          rc::gen::container<std::string>(rc::gen::elementOf(std::string("0000123456789"))));
    };
    const std::string text = "XY" + signs + of_length(10) +
                             *rc::gen::element<std::string>("", ".", "..") + of_length(10) +
                             *rc::gen::element<std::string>("", " ", "Y1.25", "      Z-1", "\xb5");
    const char* const end = text.data() + text.size();
    for (std::size_t at = 0; at <= text.size(); ++at) {
      Number number;
      if (read_short_number(text.data(), text.data() + at, end, number)) {
        const Number other = read_number(std::string_view(text).substr(at));
        RC_ASSERT(number.length == other.length);
        RC_ASSERT(std::bit_cast<std::uint64_t>(number.value) ==
                  std::bit_cast<std::uint64_t>(other.value));
        RC_ASSERT(number.decimal_point == other.decimal_point);
      } else {
        RC_ASSERT(number.length == 0U);
      }
    }
  }));
}

// Eight bytes hold seven digits and a point.
TEST(Number, IsShortWithSevenDigitsOnEitherSideAtMost) {
  const auto is_short = [](std::string_view text) {
    Number number;
    return read_short_number(text.data(), text.data(), text.data() + text.size(), number);
  };
  EXPECT_TRUE(is_short("-1234567.1234567"));
  EXPECT_TRUE(is_short(".1234567"));
  EXPECT_TRUE(is_short("+1234567."));
  EXPECT_FALSE(is_short("12345678.0"));
  EXPECT_FALSE(is_short("0.12345678"));
  EXPECT_FALSE(is_short("123456"));  // the text itself must have eight bytes
}

TEST(Number, StopsWhereTheNumberStops) {
  // Words may follow without a blank.
  EXPECT_EQ(read_number("12.5Y3").length, 4U);
  EXPECT_EQ(read_number("1.2.3").length, 3U);
  EXPECT_EQ(read_number("5E3").length, 1U);  // E is a word of its own
  EXPECT_TRUE(read_number("5.").decimal_point);
  EXPECT_FALSE(read_number("5").decimal_point);
}

TEST(Number, IsNotFoundWithoutADigit) {
  // "nan" and "inf" are numbers to the C library, but not to a control.
  for (const char* text : {"", "-", "+", ".", "-.", "X", "nan", "inf", "--1", " 1"}) {
    EXPECT_EQ(read_number(text).length, 0U) << text;
  }
}

// An infinity as a coordinate would be worse than a refusal.
TEST(Number, IsNotFoundBeyondEveryDouble) {
  EXPECT_EQ(read_number(std::string(400, '9')).length, 0U);
}

}  // namespace
}  // namespace steadyrest::nc::read
