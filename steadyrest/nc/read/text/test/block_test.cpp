// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include <steadyrest/nc/read/text/block.hpp>

namespace steadyrest::nc::read {
namespace {

Word lettered(char letter, double value) {
  Word word;
  word.letter = letter;
  word.value = value;
  return word;
}

TEST(Block, KeepsItsWordsInOrderUntilItIsReset) {
  Block block;
  block.reset(4);
  EXPECT_TRUE(block.push(lettered('X', 1.0)));
  EXPECT_TRUE(block.push(lettered('Y', 2.0)));
  block.set_deleted();
  block.set_end_mark();
  block.flow().kind = FlowKind::call;
  ASSERT_EQ(block.words().size(), 2U);
  EXPECT_EQ(block.words()[0].letter, 'X');
  EXPECT_EQ(block.words()[1].value, 2.0);
  EXPECT_EQ(block.line(), 4U);
  block.reset(5);
  EXPECT_TRUE(block.words().empty());
  EXPECT_EQ(block.line(), 5U);
  EXPECT_FALSE(block.deleted());
  EXPECT_FALSE(block.end_mark());
  EXPECT_EQ(block.flow().kind, FlowKind::none);
}

TEST(Block, HoldsAHundredAndTwentyEightWordsByEitherWay) {
  Block block;
  block.reset(1);
  for (std::size_t i = 0; i < 127; ++i) {
    ASSERT_TRUE(block.push(lettered('X', 1.0)));
  }
  ASSERT_NE(block.add(), nullptr);
  EXPECT_EQ(block.add(), nullptr);
  EXPECT_FALSE(block.push(lettered('Y', 1.0)));
  EXPECT_EQ(block.words().size(), 128U);
}

// The words of an earlier line lie in the same places.
TEST(Block, ANewWordIsNeitherCalculatedNorQualifiedAsTheOldOneWas) {
  Block block;
  block.reset(1);
  Word calculated = lettered('X', 1.0);
  calculated.calculated = true;
  calculated.qualifier = Qualifier::incremental;
  EXPECT_TRUE(block.push(calculated));
  block.reset(2);
  const Word* const word = block.add();
  ASSERT_NE(word, nullptr);
  EXPECT_FALSE(word->calculated);
  EXPECT_EQ(word->qualifier, Qualifier::none);
}

TEST(Block, ShowsAnothersWordsUntilItIsReset) {
  Block read;
  read.reset(1);
  EXPECT_TRUE(read.push(lettered('Z', 3.0)));
  read.set_deleted();
  Block block;
  block.reset(9);
  block.take_words(read);
  ASSERT_EQ(block.words().size(), 1U);
  EXPECT_EQ(block.words().data(), read.words().data());
  EXPECT_TRUE(block.deleted());
  EXPECT_EQ(block.line(), 9U);
  block.reset(10);
  EXPECT_TRUE(block.push(lettered('A', 4.0)));
  EXPECT_EQ(block.words()[0].letter, 'A');
  EXPECT_EQ(read.words()[0].letter, 'Z');
}

}  // namespace
}  // namespace steadyrest::nc::read
