// SPDX-License-Identifier: Apache-2.0
#include <string>

#include <gtest/gtest.h>

#include <steadyrest/nc/interpret/state/refusals.hpp>
#include <steadyrest/nc/read/reader.hpp>

namespace steadyrest::nc::interpret {
namespace {

/// Refusals of the block of one line, number 6.
class RefusalsOf {
 public:
  RefusalsOf(const char* line, read::Dialect dialect) : reader_(dialect) {
    EXPECT_TRUE(reader_.read(line, 6, 1, block_)) << line;
    step.reset(block_);
  }
  /// The word that the last refusal shows.
  [[nodiscard]] std::string shown() const {
    EXPECT_EQ(refusals.last().line, 6U);
    EXPECT_EQ(refusals.last().reason, "why");
    EXPECT_EQ(refusals.last().text, "what to do");
    return refusals.last().word;
  }
  Step step{};
  Refusals refusals;

 private:
  read::Reader reader_;
  read::Block block_;
};

TEST(Refusals, ShowTheWordThatIsMeantAsItIsWritten) {
  RefusalsOf of("g01.0 X12.50 M03 f 100", read::Dialect::linuxcnc);
  EXPECT_FALSE(of.refusals.letter(of.step, 'X', "why", "what to do"));
  EXPECT_EQ(of.shown(), "X12.50");
  EXPECT_FALSE(of.refusals.letter(of.step, 'F', "why", "what to do"));
  EXPECT_EQ(of.shown(), "f 100");
  EXPECT_FALSE(of.refusals.g_word(of.step, g::kLinear, "why", "what to do"));
  EXPECT_EQ(of.shown(), "g01.0");
  EXPECT_FALSE(of.refusals.m_word(of.step, m::kClockwise, "why", "what to do"));
  EXPECT_EQ(of.shown(), "M03");
  EXPECT_FALSE(of.refusals.block(of.step, "why", "what to do"));
  EXPECT_EQ(of.shown(), "g01.0");
}

// CR= acts as R, TURN= as P: no word of the block has that letter.
TEST(Refusals, ShowTheLastWordWhereADialectHasAnotherNameForTheLetter) {
  RefusalsOf of("G2 X1 CR=5", read::Dialect::sinumerik);
  EXPECT_FALSE(of.refusals.letter(of.step, 'R', "why", "what to do"));
  EXPECT_EQ(of.shown(), "CR=5");
}

// G80 in force from an earlier block, M5 that nothing in the block says.
TEST(Refusals, ShowTheFirstWordWhereTheCodeIsNotInTheBlock) {
  RefusalsOf of("X1 G1 M3", read::Dialect::linuxcnc);
  EXPECT_FALSE(of.refusals.g_word(of.step, g::kCycleEnd, "why", "what to do"));
  EXPECT_EQ(of.shown(), "X1");
  EXPECT_FALSE(of.refusals.m_word(of.step, m::kSpindleStop, "why", "what to do"));
  EXPECT_EQ(of.shown(), "X1");
}

TEST(Refusals, ShowTheNameOfACallInPrintableForm) {
  Refusals refusals;
  read::Flow call{};
  for (const char c : {'P', '\x01', '1'}) {
    call.label.push(c);
  }
  EXPECT_FALSE(refusals.call(3, call, "why", "what to do"));
  EXPECT_EQ(refusals.last().word, "P\\x011");
  EXPECT_EQ(refusals.last().line, 3U);
}

}  // namespace
}  // namespace steadyrest::nc::interpret
