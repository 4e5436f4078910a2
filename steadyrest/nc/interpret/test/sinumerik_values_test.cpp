// SPDX-License-Identifier: Apache-2.0
#include <string>

#include <gmock/gmock.h>

#include <steadyrest/nc/interpret/test/moves.hpp>
#include <steadyrest/nc/interpret/test/sinumerik.hpp>

namespace steadyrest::nc::interpret {
namespace {

using test::reason_of_block;
using test::sinumerik;
using test::sinumerik_x_of;
using testing::ElementsAre;

double r_value_of(const std::string& expression) {
  return sinumerik_x_of("R1=" + expression + "\nG0 X=R1\nM30\n").at(0);
}

// SINUMERIK 840D sl "Job planning", "Priority of the operations".
TEST(SinumerikValues, HaveThePrioritiesOfTheManual) {
  EXPECT_EQ(r_value_of("1+2*3"), 7.0);
  EXPECT_EQ(r_value_of("(1+2)*3"), 9.0);
  EXPECT_EQ(r_value_of("7 DIV 2*2"), 6.0);
  EXPECT_EQ(r_value_of("8-2-1"), 5.0);
  EXPECT_EQ(r_value_of("1+2==3"), 1.0);            // comparisons are the weakest
  EXPECT_EQ(r_value_of("1 B_OR 2 B_AND 2"), 3.0);  // B_AND before B_OR
  EXPECT_EQ(r_value_of("4 B_OR 1+2"), 7.0);        // + before the bits
  EXPECT_EQ(r_value_of("1 OR 0 AND 0"), 1.0);
  EXPECT_EQ(r_value_of("NOT 0 AND 0"), 0.0);
  EXPECT_EQ(r_value_of("-2+5"), 3.0);
  EXPECT_EQ(r_value_of("-(2+5)"), -7.0);
}

// The same manual, "Arithmetic operations": 3/4=0.75, 3 DIV 4=0, 3 MOD 4=3;
// ATAN2(30.5,80.1)=20.8455.
TEST(SinumerikValues, AreThoseThatTheManualPrints) {
  EXPECT_EQ(r_value_of("3/4"), 0.75);
  EXPECT_EQ(r_value_of("3 DIV 4"), 0.0);
  EXPECT_EQ(r_value_of("3 MOD 4"), 3.0);
  EXPECT_NEAR(r_value_of("ATAN2(30.5,80.1)"), 20.8455, 5e-5);
  EXPECT_EQ(r_value_of("POT(5)"), 25.0);
  EXPECT_EQ(r_value_of("TRUNC(-2.7)+ROUND(2.5)"), 1.0);
  EXPECT_EQ(r_value_of("SQRT(POT(3)+POT(4))"), 5.0);
  EXPECT_EQ(r_value_of("-0.1EX-5*1EX6"), -1.0);
  EXPECT_EQ(r_value_of("BOUND(1,5,9)+MINVAL(1,2)+MAXVAL(1,2)"), 8.0);
  EXPECT_NEAR(r_value_of("ACOS(0.5)"), 60.0, 1e-12);
}

// The manual's example of TRUNC: R1=61.01 R2=61.02 R3=0.01, its comparison is not fulfilled.
TEST(SinumerikValues, CompareWithARelativeTolerance) {
  EXPECT_EQ(sinumerik_x_of("R1=61.01 R2=61.02 R3=0.01\nR4=ABS((R2-R1)/R3-1)>10EX-5\n"
                           "G0 X=R4\nM30\n")
                .at(0),
            0.0);
  EXPECT_EQ(sinumerik_x_of("R1=0.1+0.2\nR2=R1==0.3\nG0 X=R2\nM30\n").at(0), 1.0);
}

TEST(SinumerikValues, StandInEveryAddress) {
  const auto moves = moves_of(
      "DEF REAL WIDTH=20, FEED\nDEF INT COUNT=2.6\nDEF BOOL _ON=7\nFEED=WIDTH*10\nR[1+1]=COUNT\n"
      "G1 X=WIDTH/2 Y=AC(R2) Z=IC(-_ON) F=FEED\nG2 X=WIDTH CR=WIDTH/4\nG4 F=R2/2\n"
      "G3 X=IC(-10) I=AC(WIDTH-5) J=0 TURN=COUNT\nM30\n",
      sinumerik());
  ASSERT_EQ(moves.size(), 4U);
  // 20/2; INT rounds 2.6 to 3; BOOL 7 is 1; 20·10 mm/min; TURN=3 is four turns in all.
  EXPECT_EQ(moves[0].end[0], 10.0);
  EXPECT_EQ(moves[0].end[1], 3.0);
  EXPECT_EQ(moves[0].end[2], -1.0);
  EXPECT_DOUBLE_EQ(moves[0].feed_mm_s, 200.0 / 60.0);
  EXPECT_EQ(moves[1].centre_mm[0], 15.0);
  EXPECT_EQ(moves[2].dwell_s, 1.5);
  EXPECT_EQ(moves[3].turns, 4);
}

TEST(SinumerikValues, AreRefusedWhereTheyAreNotKnown) {
  EXPECT_EQ(reason_of_block("G0 X=R1"), "unset_parameter");
  EXPECT_EQ(reason_of_block("G0 X=WIDTH"), "variable");
  EXPECT_EQ(reason_of_block("WIDTH=5"), "variable");
  EXPECT_EQ(reason_of_block("R1000=5"), "no_such_parameter");
  EXPECT_EQ(reason_of_block("R1=5 R2=R1"), "order_of_assignments");
  EXPECT_EQ(reason_of_block("R1=5 X1"), "assignment_and_words");
  EXPECT_EQ(reason_of_block("G0 X1 R1=5"), "assignment_and_words");
  EXPECT_EQ(reason_of_block("DEF REAL AREA[0]"), "array");
  EXPECT_EQ(reason_of_block("DEF STRING[5] NOTE=5 X1"), "definition");
  EXPECT_EQ(reason_of_block("DEF REAL WIDTH\nDEF INT WIDTH"), "definition");
  EXPECT_EQ(reason_of_block("R1=-3 MOD 2"), "out_of_domain");
}

TEST(SinumerikValues, AreNotSetInBlocksThatAreLeftOut) {
  Config config = sinumerik();
  config.block_delete = true;
  EXPECT_THAT(sinumerik_x_of("R1=1\n/R1=2\nG0 X=R1\nM30\n", config), ElementsAre(1));
}

}  // namespace
}  // namespace steadyrest::nc::interpret
