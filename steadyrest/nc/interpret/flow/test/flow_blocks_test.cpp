// SPDX-License-Identifier: Apache-2.0
// Programs whose result is known from elsewhere, and O-words that do not belong together. rs274
// (LinuxCNC 2.9) ends the first ones at the same X and refuses the others too.
#include <numeric>
#include <string>
#include <utility>

#include <fmt/core.h>
#include <gtest/gtest.h>
#include <rapidcheck.h>

#include <steadyrest/nc/interpret/test/moves.hpp>

namespace steadyrest::nc::interpret {
namespace {

/// X where a program ends.
double last_x_of(const std::string& text) {
  const auto moves = moves_of(text);
  return moves.empty() ? -12345.0 : moves.back().end[0];
}

// 27 needs 111 steps to reach 1 (OEIS A006577).
TEST(FlowBlocks, CountTheStepsOfCollatzsSequence) {
  EXPECT_EQ(last_x_of("#1=27\n#2=0\no1 while [#1 NE 1]\no2 if [#1 MOD 2 EQ 0]\n#1=[#1/2]\no2 else\n"
                      "#1=[3*#1+1]\no2 endif\n#2=[#2+1]\no1 endwhile\nG0 X#2\nM2\n"),
            111.0);
}

// 25 primes below 100 (OEIS A000720), by trial division: a do loop in a while loop, with break and
// continue.
TEST(FlowBlocks, CountThePrimesBelowAHundred) {
  EXPECT_EQ(last_x_of("#1=1\n#3=0\no1 while [#1 LT 99]\n#1=[#1+1]\n#2=1\no2 do\n#2=[#2+1]\n"
                      "o3 if [#2 EQ #1]\n#3=[#3+1]\no2 break\no3 endif\no4 if [#1 MOD #2 EQ 0]\n"
                      "o1 continue\no4 endif\no2 while [1]\no1 endwhile\nG0 X#3\nM2\n"),
            25.0);
}

// Nine calls deep, and not ten: 9! = 362880.
TEST(FlowBlocks, CallThemselvesNineDeep) {
  const std::string factorial =
      "o<f> sub\no1 if [#1 LE 1]\no<f> return [1]\no1 endif\no<f> call [#1-1]\n"
      "o<f> endsub [#1*#<_value>]\n";
  EXPECT_EQ(last_x_of(factorial + "o<f> call [9]\nG0 X#<_value>\nM2\n"), 362880.0);
  EXPECT_EQ(reason_of(factorial + "o<f> call [10]\nG0 X#<_value>\nM2\n"), "calls_too_deep");
}

TEST(FlowBlocks, FindTheGreatestCommonDivisorOfAnyPair) {
  EXPECT_TRUE(rc::check([] {
    const int a = *rc::gen::inRange(1, 300);
    const int b = *rc::gen::inRange(1, 300);
    const std::string text = fmt::format(
        "#1={}\n#2={}\no1 do\no2 if [#1 GT #2]\n#1=[#1-#2]\no2 elseif [#2 GT #1]\n#2=[#2-#1]\n"
        "o2 else\no1 break\no2 endif\no1 while [1]\nG0 X#1\nM2\n",
        a, b);
    RC_ASSERT(last_x_of(text) == std::gcd(a, b));
  }));
}

TEST(FlowBlocks, NestRepeatsWhoseTurnsMultiply) {
  EXPECT_EQ(last_x_of("G91\no1 repeat [3]\no2 repeat [4]\no3 repeat [5]\nG0 X1\no3 endrepeat\n"
                      "o2 endrepeat\no1 endrepeat\nM2\n"),
            60.0);
}

TEST(FlowBlocks, AreRefusedWhereTheirWordsDoNotBelongTogether) {
  const std::pair<const char*, const char*> cases[] = {
      {"o1 endif", "o_word_unmatched"},
      {"o1 else", "o_word_unmatched"},
      {"o1 endwhile", "o_word_unmatched"},
      {"o1 endrepeat", "o_word_unmatched"},
      {"o1 endsub", "o_word_unmatched"},
      {"o1 break", "o_word_unmatched"},
      {"o1 continue", "o_word_unmatched"},
      {"o1 repeat [2]\no1 break\no1 endrepeat", "o_word_unmatched"},
      {"o1 if [1]\no2 endif\no1 endif", "o_word_unmatched"},
      {"o1 while [1]\no1 endrepeat", "o_word_unmatched"},
      {"o1 if [1]\no1 endif\no1 if [1]\no1 endif", "o_word_twice"},
      {"o1 sub\no1 endsub\no1 sub\no1 endsub", "o_word_misplaced"},
      {"o1 sub\no2 sub\no2 endsub\no1 endsub", "o_word_misplaced"},
      {"o1 while [0]\nG0 X1", "o_word_without_end"},
      {"o1 call", "o_word_without_end"}};
  for (const auto& [text, expected] : cases) {
    EXPECT_EQ(reason_of(std::string{text} + "\nM2\n"), expected) << text;
  }
}

}  // namespace
}  // namespace steadyrest::nc::interpret
