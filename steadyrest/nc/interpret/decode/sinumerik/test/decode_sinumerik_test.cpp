// SPDX-License-Identifier: Apache-2.0
// SINUMERIK 840D sl, "Fundamentals": G functions, M functions and addresses.
#include <string>
#include <utility>

#include <gtest/gtest.h>

#include <steadyrest/nc/interpret/test/sinumerik.hpp>

namespace steadyrest::nc::interpret {
namespace {

using test::reason_of_block;
using test::sinumerik;

std::vector<Move> sinumerik_moves(const std::string& text, const Config& config = sinumerik()) {
  return moves_of(text + "\nM30\n", config);
}

// G54 to G57, then G505 on; G500 switches them off, G53 and SUPA for one block.
TEST(DecodeSinumerik, HasItsSettableOffsetsUnderTheirOwnNumbers) {
  Config config = sinumerik();
  for (std::size_t i = 0; i < kWorkOffsets; ++i) {
    config.work_offset[i][0] = 100.0 * static_cast<double>(i + 1);
  }
  const auto moves = sinumerik_moves(
      "G54 G0 X1\nG55 X1\nG56 X1\nG57 X1\nG505 X1\nG506 X1\nG507 X1\nG508 X1\nG509 X1\nG500 X1\n"
      "G55 G53 X1\nX1",
      config);
  const double machine[] = {101, 201, 301, 401, 501, 601, 701, 801, 901, 1, 1, 201};
  ASSERT_EQ(moves.size(), 12U);
  for (std::size_t i = 0; i < moves.size(); ++i) {
    EXPECT_DOUBLE_EQ(moves[i].end[0] + moves[i].offset[0], machine[i]) << i;
  }
  EXPECT_EQ(reason_of_block("G500 G54"), "same_modal_group");
  EXPECT_EQ(reason_of_block("G58 X1"), "g_code_not_interpreted");
}

// G4 F in seconds, G4 S in revolutions of the spindle.
TEST(DecodeSinumerik, DwellsBySecondsOrByRevolutions) {
  const auto moves = sinumerik_moves("S600 M3\nG4 F2.5\nG4 S20\nG1 X1 F60");
  ASSERT_EQ(moves.size(), 3U);
  EXPECT_EQ(moves[0].dwell_s, 2.5);
  EXPECT_DOUBLE_EQ(moves[1].dwell_s, 2.0);  // 20 of 600 a minute
  EXPECT_DOUBLE_EQ(moves[2].feed_mm_s, 1.0);
  EXPECT_DOUBLE_EQ(moves[2].spindle_rev_s, 10.0);  // S beside G4 is no speed
  EXPECT_EQ(reason_of_block("G4 S20"), "spindle_speed_missing");
  EXPECT_EQ(reason_of_block("G4 F1 X1"), "g4_with_motion");
}

// AC and IC beside G90 and G91, in axis and centre words.
TEST(DecodeSinumerik, MixesAbsoluteAndIncrementalWords) {
  const auto moves = sinumerik_moves(
      "G90 G0 X10 Y10\nX=IC(5) Y20\nG91 X=AC(1) Y=IC(2)\nG90 G3 X=IC(10) Y22 I=AC(6) J0 F100");
  ASSERT_EQ(moves.size(), 4U);
  EXPECT_EQ(moves[1].end[0], 15.0);
  EXPECT_EQ(moves[1].end[1], 20.0);
  EXPECT_EQ(moves[2].end[0], 1.0);
  EXPECT_EQ(moves[2].end[1], 22.0);
  EXPECT_EQ(moves[3].end[0], 11.0);
  EXPECT_EQ(moves[3].centre_mm[0], 6.0);
  EXPECT_EQ(reason_of_block("G1 X1 F=IC(100)"), "bad_value");
}

// TURN counts the full circles beyond the arc: 0 to 999.
TEST(DecodeSinumerik, CountsTheTurnsOfAHelixBeyondTheFirst) {
  for (const int turns : {0, 1, 999}) {
    const auto moves =
        sinumerik_moves("G0 X10\nG2 X-10 I-10 J0 Z-5 F100 TURN=" + std::to_string(turns));
    ASSERT_EQ(moves.size(), 2U);
    EXPECT_EQ(moves[1].turns, -1 - turns);
  }
  for (const char* turns : {"-1", "1000", "0.5"}) {
    EXPECT_EQ(reason_of_block(std::string{"G0 X10\nG2 X-10 I-10 J0 F100 TURN="} + turns),
              "arc_turns");
  }
}

TEST(DecodeSinumerik, RefusesByNameWhatItDoesNotExecute) {
  const std::pair<const char*, const char*> cases[] = {{"G110 X1 F5 G0", "data_and_motion"},
                                                       {"G291", "g_code_not_interpreted"},
                                                       {"H5", "auxiliary_function"},
                                                       {"G1.5 X1", "unknown_g_code"},
                                                       {"Q1", "unknown_word"},
                                                       {"G1 X=\"A\" F100", "bad_value"},
                                                       {"D1.5", "no_such_tool"},
                                                       {"D1 D2", "word_twice"},
                                                       {"RPL=30 X1", "unused_word"},
                                                       {"ADIS=-1", "out_of_range"},
                                                       {"TRANS ROT", "frame"},
                                                       {"G95 G96 S100", "same_modal_group"},
                                                       {"RET X1", "subprogram_end"},
                                                       {"M17", "subprogram_end"},
                                                       {"G2 X1 CR", "missing_value"}};
  for (const auto& [text, expected] : cases) {
    EXPECT_EQ(reason_of_block(text), expected) << text;
  }
}

}  // namespace
}  // namespace steadyrest::nc::interpret
