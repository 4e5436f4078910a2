// SPDX-License-Identifier: Apache-2.0
// Every byte against the C library in its own locale, which is plain ASCII.
#include <cctype>

#include <gtest/gtest.h>

#include <steadyrest/nc/read/text/character.hpp>

namespace steadyrest::nc::read {
namespace {

constexpr int kBytes = 256;

TEST(Character, BelongsToTheClassesOfTheCLibrary) {
  for (int byte = 0; byte < kBytes; ++byte) {
    const char c = static_cast<char>(byte);
    EXPECT_EQ(is_digit(c), std::isdigit(byte) != 0) << byte;
    EXPECT_EQ(is_letter(c), std::isalpha(byte) != 0) << byte;
    EXPECT_EQ(is_blank(c), std::isblank(byte) != 0) << byte;
    EXPECT_EQ(in_name(c), std::isalnum(byte) != 0 || c == '_') << byte;
    // A tabulator is a blank in a program.
    EXPECT_EQ(is_control(c), std::iscntrl(byte) != 0 && c != '\t') << byte;
  }
}

TEST(Character, ChangesCaseAsTheCLibraryDoes) {
  for (int byte = 0; byte < kBytes; ++byte) {
    const char c = static_cast<char>(byte);
    EXPECT_EQ(upper(c), static_cast<char>(std::toupper(byte))) << byte;
    EXPECT_EQ(lower(c), static_cast<char>(std::tolower(byte))) << byte;
  }
}

}  // namespace
}  // namespace steadyrest::nc::read
