// SPDX-License-Identifier: Apache-2.0
// What a refusal shows of a program goes to terminals and into JSON.
#include <algorithm>
#include <string>

#include <gtest/gtest.h>
#include <rapidcheck.h>

#include <steadyrest/nc/read/text/reading.hpp>
#include <steadyrest/nc/read/text/refused.hpp>

namespace steadyrest::nc::read {
namespace {

using namespace std::string_literals;

TEST(Printable, LeavesPlainTextAsItIs) {
  std::string all;
  for (char c = ' '; c <= '~'; ++c) {
    all += c;
  }
  EXPECT_EQ(printable(all.substr(0, 50)), all.substr(0, 50));
  EXPECT_EQ(printable(all.substr(50)), all.substr(50));
}

TEST(Printable, WritesEveryOtherByteInHexadecimal) {
  EXPECT_EQ(printable("X1\t"), "X1\\x09");
  EXPECT_EQ(printable("\0\x1f\x7f\x80\xff"s), "\\x00\\x1f\\x7f\\x80\\xff");
  EXPECT_EQ(printable("\x1b[2J"), "\\x1b[2J");  // no escape sequence reaches the terminal
  EXPECT_EQ(printable("\xc3\xa4"), "\\xc3\\xa4");
}

TEST(Printable, BreaksOffAfterSixtyCharacters) {
  EXPECT_EQ(printable(std::string(60, 'X')), std::string(60, 'X'));
  EXPECT_EQ(printable(std::string(61, 'X')), std::string(60, 'X') + "...");
  EXPECT_TRUE(rc::check([](const std::string& text) {
    const std::string shown = printable(text);
    RC_ASSERT(shown.size() <= 66U);  // a byte may be the last with four characters, then the dots
    RC_ASSERT(std::ranges::all_of(shown, [](char c) { return c >= ' ' && c <= '~'; }));
  }));
}

TEST(Reading, KeepsTheLastRefusalInPrintableForm) {
  Reading reading;
  EXPECT_FALSE(reading.refuse(7, "X1\x01", "bad_number", "not a number"));
  EXPECT_FALSE(reading.refuse(9, "Y\x02", "missing_value", "a letter without its number"));
  EXPECT_EQ(reading.refused.line, 9U);
  EXPECT_EQ(reading.refused.word, "Y\\x02");
  EXPECT_EQ(reading.refused.reason, "missing_value");
  EXPECT_EQ(reading.refused.text, "a letter without its number");
  EXPECT_TRUE(reading.refused.file.empty());
}

}  // namespace
}  // namespace steadyrest::nc::read
