// SPDX-License-Identifier: Apache-2.0
#include <cstdlib>
#include <string>

#include <gtest/gtest.h>
#include <rapidcheck.h>

#include <steadyrest/nc/read/number.hpp>

namespace steadyrest::nc::read {
namespace {

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

TEST(Number, StopsWhereTheNumberStops) {
  EXPECT_EQ(read_number("12.5Y3").length, 4U);
  EXPECT_EQ(read_number("1.2.3").length, 3U);
  EXPECT_EQ(read_number("5E3").length, 1U);  // E is a word of its own
  EXPECT_TRUE(read_number("5.").decimal_point);
  EXPECT_FALSE(read_number("5").decimal_point);
}

TEST(Number, IsNotFoundWithoutADigit) {
  for (const char* text : {"", "-", "+", ".", "-.", "X", "nan", "inf", "--1", " 1"}) {
    EXPECT_EQ(read_number(text).length, 0U) << text;
  }
}

TEST(Number, IsNotFoundBeyondEveryDouble) {
  EXPECT_EQ(read_number(std::string(400, '9')).length, 0U);
}

}  // namespace
}  // namespace steadyrest::nc::read
