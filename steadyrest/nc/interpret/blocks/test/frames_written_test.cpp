// SPDX-License-Identifier: Apache-2.0
// Frames that a SINUMERIK program writes as data.
#include <string>
#include <utility>

#include <gmock/gmock.h>

#include <steadyrest/nc/interpret/test/moves.hpp>
#include <steadyrest/nc/interpret/test/sinumerik.hpp>

namespace steadyrest::nc::interpret {
namespace {

using test::reason_of_block;
using test::sinumerik;

/// Machine X and Y of a program's last move.
std::pair<double, double> last_of(const std::string& text, const Config& config = sinumerik()) {
  const auto moves = moves_of("G17 G71 G90\n" + text + "\nM30\n", config);
  const Axes at = machine_of(moves.back(), moves.back().end);
  return {at[0], at[1]};
}
auto near(double x, double y) {
  return testing::Pair(testing::DoubleNear(x, 1e-9), testing::DoubleNear(y, 1e-9));
}

// "Job planning", $P_UIFR: it acts when the settable offset is next selected.
TEST(WrittenFrames, ActWhenTheyAreSelected) {
  Config config = sinumerik();
  config.work_offset[1] = {100.0, 50.0, 20.0};
  EXPECT_THAT(last_of("G500\n$P_UIFR[1]=CTRANS(X,10,Y,20)\nG54\nG0 X1 Y2"), near(11, 22));
  EXPECT_THAT(last_of("$P_UIFR[2,X,TR]=-7.5\nG55\nG0 X1 Y2", config), near(-6.5, 52));
  EXPECT_THAT(last_of("R1=3\n$P_UIFR[2]=CTRANS(Y,R1*2)\nG55\nG0 X1 Y2", config), near(1, 8));
  EXPECT_THAT(last_of("$P_UIFR[5]=CTRANS(X,3)\nG505\nG0 X1 Y2", config), near(4, 2));
  // In force: not yet, then.
  EXPECT_THAT(last_of("G55\n$P_UIFR[2,X,TR]=7\nG0 X1 Y2", config), near(101, 52));
  EXPECT_THAT(last_of("G55\n$P_UIFR[2,X,TR]=7\nG55\nG0 X1 Y2", config), near(8, 52));
}

TEST(WrittenFrames, TurnAboutZBehindTheirShift) {
  EXPECT_THAT(last_of("$P_UIFR[2]=CTRANS(X,10):CROT(Z,90)\nG55\nG0 X1 Y2"), near(8, 1));
  EXPECT_THAT(last_of("$P_UIFR[2,Z,RT]=90\nG55\nG0 X1 Y2"), near(-2, 1));
  EXPECT_THAT(last_of("$P_PFRAME=CTRANS(X,10,Y,5):CROT(Z,90)\nG0 X1 Y2"), near(8, 6));
  // The same by words.
  EXPECT_THAT(last_of("TRANS X10 Y5\nAROT Z90\nG0 X1 Y2"), near(8, 6));
  EXPECT_THAT(last_of("TRANS X10 Y5\n$P_PFRAME=CTRANS()\nG0 X1 Y2"), near(1, 2));
}

TEST(WrittenFrames, AreRefusedInFormsThatAreNotRead) {
  EXPECT_EQ(reason_of_block("$P_UIFR[1]=CMIRROR(X)"), "frame");
  EXPECT_EQ(reason_of_block("$P_UIFR[1]=CROT(Z,5):CTRANS(X,1)"), "frame");
  EXPECT_EQ(reason_of_block("$P_UIFR[1]=CTRANS(X,1):CROT(X,5)"), "frame");
  EXPECT_EQ(reason_of_block("$P_UIFR[1]=CTRANS(X,1"), "unclosed_expression");
  EXPECT_EQ(reason_of_block("$P_UIFR[0]=CTRANS(X,1)"), "parameter");
  EXPECT_EQ(reason_of_block("$P_UIFR[1.5]=CTRANS(X,1)"), "parameter");
  EXPECT_EQ(reason_of_block("$P_UIFR[1,X,MI]=1"), "parameter");
  EXPECT_EQ(reason_of_block("$P_UIFR[1,X,TR]=1 G0"), "assignment_and_words");
  EXPECT_EQ(reason_of_block("$P_UIFR[1]=CTRANS(V,1)"), "no_such_axis");
  EXPECT_EQ(reason_of_block("G54\n$P_UIFR[1,Z,RT]=5"), "frame");
  EXPECT_EQ(reason_of_block("G700\n$P_UIFR[1,X,TR]=5"), "frame");
  EXPECT_EQ(reason_of_block("$P_PFRAME[X,TR]=5"), "parameter");
  EXPECT_EQ(reason_of_block("$P_PFRAME=CTRANS(X,5)\nG0 X=IC(1)"), "frame_incremental");
  EXPECT_EQ(reason_of_block("$P_CHBFR[0]=CTRANS(X,5)"), "parameter");
}

}  // namespace
}  // namespace steadyrest::nc::interpret
