// SPDX-License-Identifier: Apache-2.0
#include <string>
#include <vector>

#include <steadyrest/nc/interpret/test/moves.hpp>

// `,C` and `,R` in programs: the moves, their lines, and what may not be around them.
namespace steadyrest::nc::interpret {
namespace {

Config cornered() {
  Config config;
  config.dialect = read::Dialect::fanuc;
  config.unit_known = true;
  return config;
}

std::string corner_fault(const std::string& text) {
  return reason_of("G17 G90 G0 X0 Y0 Z0 F100.\n" + text + "\nM30\n", cornered());
}

// "Optional chamfering and corner R": a square with a chamfer, a rounding, and both in a row.
TEST(Corners, CutAndRoundThePathOfTheProgram) {
  const auto moves = moves_of(
      "G17 G90 G0 X0 Y0 F100.\nG1 X30. ,C3.\nY20. ,R5.\nX0 F50.\nG0 Y0\nM30\n", cornered());
  ASSERT_EQ(moves.size(), 7U);
  EXPECT_EQ(moves[1].end[0], 27.0);
  EXPECT_EQ(moves[1].line, 2U);
  EXPECT_EQ(moves[2].kind, MoveKind::linear);
  EXPECT_EQ(moves[2].start[0], 27.0);
  EXPECT_EQ(moves[2].end[0], 30.0);
  EXPECT_EQ(moves[2].end[1], 3.0);
  EXPECT_EQ(moves[2].line, 2U);
  EXPECT_EQ(moves[3].start[1], 3.0);
  EXPECT_NEAR(moves[3].end[1], 15.0, 1e-12);
  EXPECT_EQ(moves[4].kind, MoveKind::arc);
  EXPECT_EQ(moves[4].turns, 1);
  EXPECT_NEAR(moves[4].centre_mm[0], 25.0, 1e-12);
  EXPECT_NEAR(moves[4].centre_mm[1], 15.0, 1e-12);
  EXPECT_NEAR(moves[4].end[0], 25.0, 1e-12);
  EXPECT_NEAR(moves[4].feed_mm_s, 100.0 / 60.0, 1e-12);
  EXPECT_NEAR(moves[5].feed_mm_s, 50.0 / 60.0, 1e-12);
  EXPECT_EQ(moves[5].end[0], 0.0);
  for (std::size_t i = 1; i < moves.size(); ++i) {
    EXPECT_EQ(moves[i].start, moves[i - 1].end) << i;
  }
}

TEST(Corners, CountIncrementsFromTheProgrammedCorner) {
  const auto moves =
      moves_of("G17 G90 G0 X0 Y0 F100.\nG91 G1 X30. ,R3.\nY20. ,C1.\nX-30.\nM30\n", cornered());
  EXPECT_EQ(moves.back().end[0], 0.0);
  EXPECT_EQ(moves.back().end[1], 20.0);
}

TEST(Corners, RoundBesideArcsInThePlaneInForce) {
  const auto moves =
      moves_of("G18 G90 G0 X0 Y0 Z0 F100.\nG1 X20. ,R2.\nG2 Z-10. X30. I10.\nM30\n", cornered());
  ASSERT_EQ(moves.size(), 4U);
  EXPECT_EQ(moves[2].kind, MoveKind::arc);
  EXPECT_EQ(moves[2].normal[1], 1.0);
}

TEST(Corners, NeedACutAfterThemAndNothingBetween) {
  EXPECT_EQ(corner_fault("G1 X5. ,R1.\nY5."), "");
  EXPECT_EQ(corner_fault("G1 X5. ,R1.\n(A COMMENT)\n\nY5."), "");
  for (const char* next : {"G0 Y5.", "M8", "G4 X1.", "G1 Y5. M8", "G1 Z-5.", "T1", "G55", "M30"}) {
    const std::string found = corner_fault("G1 X5. ,R1.\n" + std::string(next));
    EXPECT_TRUE(found == "corner_without_next" || found == "corner_off_plane") << next << found;
  }
  EXPECT_EQ(reason_of("G90 G0 X0 Y0\nG1 X5. ,R1. F9.\n%\n", cornered()), "corner_without_next");
  EXPECT_EQ(corner_fault("G0 X5. ,R1.\nG1 Y5."), "corner_without_cut");
  EXPECT_EQ(corner_fault("G1 X5. ,R0\nY5."), "out_of_range");
  EXPECT_EQ(corner_fault("G1 X5. ,R1. ,C1.\nY5."), "word_twice");
  EXPECT_EQ(corner_fault("G1 X5. ,A1.\nY5."), "bad_character");
  EXPECT_EQ(corner_fault("G1 X5. ,R6.\nY5."), "corner_too_large");
  EXPECT_EQ(corner_fault("G1 X5. ,C1.\nX0"), "corner_reversal");
  EXPECT_EQ(corner_fault("G51 X0 Y0 Z0 P2.\nG1 X5. Y0 ,C1.\nY5."), "corner_scaled");
  Config linuxcnc;
  EXPECT_EQ(reason_of("G1 X5 ,R1 F9\nY5\nM2\n", linuxcnc), "bad_character");
}

}  // namespace
}  // namespace steadyrest::nc::interpret
