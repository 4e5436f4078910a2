// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <cctype>
#include <string>
#include <string_view>

#include <fmt/core.h>
#include <gtest/gtest.h>
#include <rapidcheck.h>
#include <rapidcheck/gtest.h>

#include <steadyrest/nc/rewrite/text/tag.hpp>

namespace steadyrest::nc::rewrite {
namespace {

// The mark begins a comment; in the middle of one, or without one, the word is the author's.
TEST(Tag, IsTheBeginningOfAComment) {
  for (const std::string_view line :
       {"G10 L2 P0 Z0.01 (STEADYREST Z 10 um)", "(MSG,STEADYREST the last run was aborted)",
        "o100 if [1] (ABORT,STEADYREST stop)", "R50=0.012 ;STEADYREST Z 12 um",
        "(author's own)(STEADYREST end)"}) {
    EXPECT_TRUE(is_inserted(line)) << line;
  }
  for (const std::string_view line :
       {"(made with STEADYREST )", "; by STEADYREST tools", "STEADYREST G0 Z5", "(STEADYREST)",
        "(steadyrest z)", "(PRINT,STEADYREST on)", ""}) {
    EXPECT_FALSE(is_inserted(line)) << line;
  }
}

TEST(Tag, TheHeadIsToldFromTheCorrections) {
  for (const std::string_view line : {"(STEADYREST head told --axis z)", ";STEADYREST head begin",
                                      "(MSG,STEADYREST aborted)", "M0 (ABORT,STEADYREST stop)"}) {
    EXPECT_TRUE(is_head(line)) << line;
  }
  EXPECT_FALSE(is_head("G10 L2 P0 Z0.01 (STEADYREST Z 10 um)"));
  EXPECT_FALSE(is_head("R50=0 ;STEADYREST Z headroom"));
}

// LinuxCNC reads the same name with blanks in it and in any case.
RC_GTEST_PROP(OwnNames, AreFoundInAnyLettersAndWithBlanks, ()) {
  std::string name;
  for (const char c : std::string(kOwnNames) + "_z>") {
    name += std::string(static_cast<std::size_t>(*rc::gen::inRange(0, 3)), ' ');
    name += *rc::gen::arbitrary<bool>() ? static_cast<char>(std::toupper(c)) : c;
  }
  RC_ASSERT(uses_own_names("#1 = [" + name + " + 2]"));
  RC_ASSERT(uses_own_names("##" + name));
  // Changing any letter makes another name.
  const auto letters = name.find_first_of("sS");
  name[letters] = 'x';
  RC_ASSERT(!uses_own_names("#1 = [" + name + " + 2]"));
}

TEST(OwnNames, EndBeforeTheLineDoes) {
  EXPECT_FALSE(uses_own_names("#<_steadyres"));
  EXPECT_FALSE(uses_own_names("#"));
  EXPECT_FALSE(uses_own_names("<_steadyrest_z>"));
  EXPECT_TRUE(uses_own_names("#5 #<_steadyrest"));
}

// R and its number, alone or after another word, with blanks between; never within a longer number
// or another name.
RC_GTEST_PROP(Parameter, IsFoundByItsNumberAlone, ()) {
  const auto number = *rc::gen::inRange<std::uint32_t>(0, 1000);
  const auto other = *rc::gen::inRange<std::uint32_t>(0, 1000);
  const std::string r = *rc::gen::element("R", "r", "R ", "r\t");
  RC_ASSERT(uses_parameter(fmt::format("N10 {}{}=5", r, number), number));
  RC_ASSERT(uses_parameter(fmt::format("X=2*{}{}", r, number), number));
  RC_ASSERT(uses_parameter(fmt::format("{}{}={}{}", r, other, r, number), number));
  RC_ASSERT(uses_parameter(fmt::format("{}{}=5", r, other), number) == (number == other));
  RC_ASSERT(!uses_parameter(fmt::format("CR={}", number), number));
  RC_ASSERT(!uses_parameter(fmt::format("_R{}=1", number), number));
  RC_ASSERT(!uses_parameter(fmt::format("X1 ; R{}", number), number));
  RC_ASSERT(uses_parameter("R[12+3]=1", number));  // it could be any
}

// 2³² + 50 is not 50, and leading zeros change nothing.
TEST(Parameter, ANumberOfManyDigitsIsNoOther) {
  EXPECT_FALSE(uses_parameter("R4294967346=1", 50));
  EXPECT_FALSE(uses_parameter("R18446744073709551666=1", 50));
  EXPECT_TRUE(uses_parameter("R0050=1", 50));
  EXPECT_FALSE(uses_parameter("R", 50));
  EXPECT_FALSE(uses_parameter("R = 50", 50));
}

// Comments begin at a semicolon, except one in a string.
TEST(Variable, IsNamedOutsideOfComments) {
  EXPECT_TRUE(names_variable("$p_uifr[1]=0", "$P_UIFR"));
  EXPECT_TRUE(names_variable("MSG(\"a;b\") $P_UIFR[1]=0", "$P_UIFR"));
  EXPECT_FALSE(names_variable("G1 X1 ; $P_UIFR[1]=0", "$P_UIFR"));
  EXPECT_FALSE(names_variable("MSG(\"a\") ; \"$P_UIFR\"", "$P_UIFR"));
  EXPECT_FALSE(names_variable("$P_UIF", "$P_UIFR"));
}

}  // namespace
}  // namespace steadyrest::nc::rewrite
