// SPDX-License-Identifier: Apache-2.0
// Words of a line or an arc in plain numbers, and all others.
#include <string>
#include <string_view>

#include <gtest/gtest.h>

#include <steadyrest/nc/read/reader.hpp>
#include <steadyrest/nc/rewrite/replace/block_words.hpp>
#include <steadyrest/nc/rewrite/replace/cut_blocks.hpp>

namespace steadyrest::nc::rewrite {
namespace {

TEST(WordBeyondACut, IsTheFirstThatIsNotOfALineOrAnArc) {
  const auto beyond = [](std::string_view line) {
    read::Reader reader(read::Dialect::linuxcnc);
    read::Block block;
    EXPECT_TRUE(reader.read(line, 1, 1, block)) << line;
    return std::string(word_beyond_a_cut(block));
  };
  EXPECT_EQ(beyond("N10 G1 X5 Y-2.5 Z+1 F100"), "");
  EXPECT_EQ(beyond("G2 X5 I2 J1 P2"), "");
  EXPECT_EQ(beyond("X5 R3"), "");
  EXPECT_EQ(beyond("G1 X5 M8 S3"), "M8");
  EXPECT_EQ(beyond("G91 X5 T1"), "G91");
  EXPECT_EQ(beyond("G0 X5"), "G0");
  EXPECT_EQ(beyond("G1 A5"), "A5");
}

TEST(IsCalculated, WhateverIsNotTheNumberItself) {
  const auto calculated = [](std::string_view text, std::string_view name = {},
                             read::Qualifier qualifier = read::Qualifier::none) {
    return is_calculated(
        {.letter = name.empty() ? 'X' : '\0', .qualifier = qualifier, .name = name, .text = text});
  };
  EXPECT_FALSE(calculated("X-1.5"));
  EXPECT_FALSE(calculated("x + 3"));
  EXPECT_FALSE(calculated("CR=7.5", "CR"));
  EXPECT_FALSE(calculated("X=AC(5)", "", read::Qualifier::absolute));
  EXPECT_FALSE(calculated("X=IC(-5)", "", read::Qualifier::incremental));
  EXPECT_TRUE(calculated("X#1"));
  EXPECT_TRUE(calculated("X[1+2]"));
  EXPECT_TRUE(calculated("X=R1"));
  EXPECT_TRUE(calculated("X=2*3"));
  EXPECT_TRUE(calculated("X=AC(R1)", "", read::Qualifier::absolute));
  EXPECT_TRUE(is_calculated({.letter = 'X', .calculated = true, .name = {}, .text = "X5"}));
}

}  // namespace
}  // namespace steadyrest::nc::rewrite
