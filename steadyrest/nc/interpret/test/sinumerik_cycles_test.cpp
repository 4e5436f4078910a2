// SPDX-License-Identifier: Apache-2.0
#include <string>

#include <gmock/gmock.h>

#include <steadyrest/nc/interpret/test/moves.hpp>
#include <steadyrest/nc/interpret/test/sinumerik.hpp>

namespace steadyrest::nc::interpret {
namespace {

using test::along;
using test::reason_of_block;
using test::sinumerik;
using testing::ElementsAre;

// Manual "Cycles", CYCLE81: G0 to reference plane and safety clearance, G1 to the depth, G0 out.
TEST(SinumerikCycles, DrillAsTheManualOrdersIt) {
  const std::string head = "G17 G90 G0 X40 Y120 Z150 F200 S300 M3\n";
  EXPECT_THAT(along(2, head + "CYCLE81(110,100,2,35)\nM30\n"), ElementsAre(150, 102, 35, 110));
  // The depth by DPR: 102 − 65 = 37.
  EXPECT_THAT(along(2, head + "CYCLE81(110,102,,,65)\nM30\n"), ElementsAre(150, 102, 37, 110));
  const auto moves = moves_of(head + "CYCLE82(110,102,4,75,,2)\nX50\nM30\n", sinumerik());
  ASSERT_EQ(moves.size(), 6U);
  EXPECT_EQ(moves[3].dwell_s, 2.0);
  EXPECT_EQ(moves[5].kind, MoveKind::rapid);  // the modal words are those before the cycle
}

TEST(SinumerikCycles, FollowEachMoveWhileMcallIsOn) {
  EXPECT_THAT(
      along(2, "G0 X0 Y0 Z50 F100\nMCALL CYCLE81(10,0,2,-5)\nX1\nF50\nY1\nMCALL\nX5\nM30\n"),
      // MCALL drills after X1 and Y1 but not after F50; X5 comes after its end.
      ElementsAre(50, 50, 2, -5, 10, 10, 2, -5, 10, 10));
}

// CYCLE85: out at its own feed to the safety clearance; CYCLE86: aside with the spindle stopped.
TEST(SinumerikCycles, ReamAndBore) {
  const std::string head = "G18 G0 Z70 X50 Y105 F100\n";
  const auto ream = moves_of(head + "CYCLE85(105,102,2,,25,,300,450)\nM30\n", sinumerik());
  ASSERT_EQ(ream.size(), 5U);
  // 102 − 25 = 77 and 102 + 2 = 104; 300 and 450 mm/min are 5 and 7.5 mm/s.
  EXPECT_EQ(ream[2].end[1], 77.0);
  EXPECT_DOUBLE_EQ(ream[2].feed_mm_s, 5.0);
  EXPECT_EQ(ream[3].end[1], 104.0);
  EXPECT_DOUBLE_EQ(ream[3].feed_mm_s, 7.5);
  EXPECT_EQ(ream[4].end[1], 105.0);
  const auto bore = moves_of(
      "G17 G0 X70 Y50 Z112 F200 S300\nCYCLE86(112,110,,77,0,2,3,-1,-1,1,45)\nM30\n", sinumerik());
  ASSERT_EQ(bore.size(), 7U);
  EXPECT_EQ(bore[2].end[2], 77.0);
  EXPECT_DOUBLE_EQ(bore[2].spindle_rev_s, 5.0);
  EXPECT_EQ(bore[4].end[0], 69.0);
  EXPECT_EQ(bore[4].end[2], 78.0);
  EXPECT_EQ(bore[4].spindle_rev_s, 0.0);
  EXPECT_EQ(bore[6].end[0], 70.0);
  EXPECT_EQ(bore[6].end[2], 112.0);
}

// CYCLE84 with the manual's values: M5 (pitch 0.8 by ISO 261), 200 rpm in, 500 rpm out.
TEST(SinumerikCycles, TapWithTheSpindlesPitch) {
  const auto moves =
      moves_of("G0 G90 X30 Y35 Z40\nCYCLE84(40,36,2,,30,,3,5,,90,200,500)\nM30\n", sinumerik());
  ASSERT_EQ(moves.size(), 5U);
  EXPECT_EQ(moves[2].kind, MoveKind::thread);
  // 36 − 30 = 6 and 36 + 2 = 38; the speed's sign reverses on the way out.
  EXPECT_EQ(moves[2].end[2], 6.0);
  EXPECT_DOUBLE_EQ(moves[2].feed_mm_s, 0.8);
  EXPECT_DOUBLE_EQ(moves[2].spindle_rev_s, 200.0 / 60.0);
  EXPECT_EQ(moves[3].end[2], 38.0);
  EXPECT_DOUBLE_EQ(moves[3].spindle_rev_s, -500.0 / 60.0);
}

TEST(SinumerikCycles, AreRefusedByName) {
  EXPECT_EQ(reason_of_block("F100\nCYCLE81(10,0,2,-5,4)"), "cycle_depth");
  EXPECT_EQ(reason_of_block("F100\nCYCLE81(1,0,2,-5)"), "cycle_planes");
  EXPECT_EQ(reason_of_block("CYCLE81(10,0,2,-5)"), "feed_missing");
  EXPECT_EQ(reason_of_block("F100\nCYCLE81(10,0,2,-5,,0,10,1,11)"), "cycle_value");
  EXPECT_EQ(reason_of_block("F100\nCYCLE81(10,0,2)"), "cycle_word_missing");
  EXPECT_EQ(reason_of_block("CYCLE71(1)"), "cycle_not_interpreted");
  EXPECT_EQ(reason_of_block("POCKET4(50,0,5,\"X\")"), "cycle_not_interpreted");
  EXPECT_EQ(reason_of_block("CYCLE800(1)"), "transformation");
  EXPECT_EQ(reason_of_block("CYCLE800(1,\"TC1\",0,57)"), "transformation");
  EXPECT_EQ(reason_of_block("MCALL L10"), "modal_call");
  EXPECT_EQ(reason_of_block("SETMS(2)"), "spindle_selection");
}

}  // namespace
}  // namespace steadyrest::nc::interpret
