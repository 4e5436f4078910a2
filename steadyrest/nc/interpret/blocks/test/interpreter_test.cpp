// SPDX-License-Identifier: Apache-2.0
#include <cmath>

#include <steadyrest/nc/interpret/test/moves.hpp>

// Expected values are rs274's output (LinuxCNC 2.9) for the same lines.
namespace steadyrest::nc::interpret {
namespace {

TEST(Interpreter, KeepsUnnamedAxesAndAddsIncrements) {
  const auto moves = moves_of("G0 X1 Y2 Z3\nG91 G1 X2 F120\nG90 Y0\nM2\n");
  ASSERT_EQ(moves.size(), 3U);
  EXPECT_EQ(moves[1].end[0], 3.0);
  EXPECT_EQ(moves[1].end[1], 2.0);
  EXPECT_EQ(moves[1].feed_mm_s, 2.0);
  EXPECT_EQ(moves[2].end[1], 0.0);
  EXPECT_EQ(moves[2].start[0], 3.0);
}

TEST(Interpreter, ReadsNumbersAcrossBlanks) {
  const auto moves = moves_of("G 0 X- 1 Y + 2 . 5 Z-\t. 5 A. 5 B-.\t5\nM 2\n");
  ASSERT_EQ(moves.size(), 1U);
  EXPECT_EQ(moves[0].end[0], -1.0);
  EXPECT_EQ(moves[0].end[1], 2.5);
  EXPECT_EQ(moves[0].end[2], -0.5);
  EXPECT_EQ(moves[0].end[3], 0.5);
  EXPECT_EQ(moves[0].end[4], -0.5);
  EXPECT_EQ(reason_of("G0 X- - 1\nM2\n"), "bad_number");
}

TEST(Interpreter, KeepsAShiftThatIsNotInForceForG92Point3) {
  Config config;
  config.g92[2] = 1.5;
  for (const bool on : {false, true}) {
    config.g92_on = on;
    const auto moves = moves_of("G0 Z1\nG92.3\nG0 Z1\nG92.2\nG0 Z1\nM2\n", config);
    EXPECT_EQ(moves.at(0).end[2] + moves.at(0).offset[2], on ? 2.5 : 1.0);
    EXPECT_EQ(moves.at(1).end[2] + moves.at(1).offset[2], 2.5);
    EXPECT_EQ(moves.at(2).end[2] + moves.at(2).offset[2], 1.0);
  }
}

TEST(Interpreter, GivesMillimetresInInchPrograms) {
  const auto moves = moves_of("G20\nF10\nG1 X1 A90\nM2\n");
  ASSERT_EQ(moves.size(), 1U);
  EXPECT_DOUBLE_EQ(moves[0].end[0], 25.4);
  EXPECT_EQ(moves[0].end[3], 90.0);
  EXPECT_DOUBLE_EQ(moves[0].feed_mm_s * 60.0, 254.0);
}

TEST(Interpreter, TakesFBeforeTheUnitsOfItsBlock) {
  const auto moves = moves_of("G20 F10 G1 X1\nM2\n");
  EXPECT_DOUBLE_EQ(moves.at(0).feed_mm_s * 60.0, 10.0);
}

TEST(Interpreter, RefusesSpiralsExactlyWhereRs274Does) {
  // The bounds of README.md from both sides, to the last digit that rs274 accepts: 0.02828 mm on a
  // small radius, 0.1 % on a large one, R short by 0.00127 mm.
  EXPECT_EQ(reason_of("F10 G2 X10.02828 I5\nM2\n"), "");
  EXPECT_EQ(reason_of("F10 G2 X10.02829 I5\nM2\n"), "arc_does_not_close");
  EXPECT_EQ(reason_of("F10 G2 X100.05 I50\nM2\n"), "");
  EXPECT_EQ(reason_of("F10 G2 X100.0501 I50\nM2\n"), "arc_does_not_close");
  EXPECT_EQ(reason_of("F10 G2 X10 R4.99874\nM2\n"), "");
  EXPECT_EQ(reason_of("F10 G2 X10 R4.99872\nM2\n"), "arc_radius_too_small");
}

TEST(Interpreter, OrientsArcsOfAllPlanesRightHanded) {
  const auto moves = moves_of("F10 G18 G2 X10 I5\nG19 G3 Y10 J5 X3\nG17 G3 I1 P3\nM2\n");
  ASSERT_EQ(moves.size(), 3U);
  // G18's plane is Z X, so its normal is +Y and clockwise is seen against it.
  EXPECT_EQ(moves[0].normal[1], 1.0);
  EXPECT_EQ(moves[0].turns, -1);
  EXPECT_EQ(moves[0].centre_mm[0], 5.0);
  EXPECT_EQ(moves[1].normal[0], 1.0);
  EXPECT_EQ(moves[1].end[0], 3.0);
  EXPECT_EQ(moves[2].turns, 3);
}

TEST(Interpreter, PutsTheCentreOfARadiusArcOnTheRightSide) {
  const auto moves = moves_of("F10 G2 X1 Y0 R0.6\nG0 X0\nG2 X1 R-0.6\nM2\n");
  // The centre is √(R² − (c/2)²) off the chord; the sign of R decides the side.
  const double height = std::sqrt(0.6 * 0.6 - 0.25);
  EXPECT_NEAR(moves.at(0).centre_mm[1], -height, 1e-12);
  EXPECT_NEAR(moves.at(2).centre_mm[1], height, 1e-12);
}

TEST(Interpreter, CarriesTheWorkPositionThroughOffsetChanges) {
  const auto moves = moves_of(
      "G0 X5\nG92 X1\nG0 Y1\nG92.1\nG0 Z1\nG10 L2 P2 X1\nG55 G0 Y2\nG43.1 Z2\nG0 Y3\nM2\n");
  // G92 X1 at X5 shifts by 4; G92.1 takes it off; G55 is at 1; a tool of 2 lowers Z by 2.
  EXPECT_EQ(moves.at(1).end[0], 1.0);
  EXPECT_EQ(moves.at(1).offset[0], 4.0);
  EXPECT_EQ(moves.at(2).end[0], 5.0);
  EXPECT_EQ(moves.at(3).end[0], 4.0);
  EXPECT_EQ(moves.at(4).end[2], -1.0);
}

TEST(Interpreter, RetractsToTheInitialLevelOrTheRPlane) {
  const auto low = moves_of("F100 G0 Z3\nG99 G81 X5 Z-1 R1\nX7\nM2\n");
  // Over the hole, down to R, drill, out: the tool reaches the second hole at R, so it needs no
  // second rapid.
  ASSERT_EQ(low.size(), 8U);
  EXPECT_EQ(low[4].end[2], 1.0);
  EXPECT_EQ(low[5].end[2], 1.0);
  const auto high = moves_of("F100 G0 Z3\nG98 G81 X5 Z-1 R1\nX7\nM2\n");
  ASSERT_EQ(high.size(), 9U);
  EXPECT_EQ(high[4].end[2], 3.0);
  EXPECT_EQ(high[2].path_mode, PathMode::exact_path);
}

TEST(Interpreter, RepeatsIncrementalCyclesWithStickyWords) {
  const auto moves = moves_of("F100 G0 X1 Y2 Z3\nG91 G81 X5 Y6 Z-1 R-1 L3\nX7\nM2\n");
  ASSERT_EQ(moves.size(), 14U);
  // Three holes of 5, 6 each from (1, 2): the last at (16, 20). X7 then drills once more.
  EXPECT_EQ(moves[8].end[0], 16.0);
  EXPECT_EQ(moves[8].end[1], 20.0);
  EXPECT_EQ(moves.back().end[0], 23.0);
  EXPECT_EQ(moves.back().end[2], 2.0);
}

TEST(Interpreter, LocksTheOverrideWhileTapping) {
  const auto moves = moves_of("F100 S60 M3\nG0 Z3\nG84 X0 Z-1 R1\nG0 X1\nM2\n");
  ASSERT_EQ(moves.size(), 7U);
  EXPECT_TRUE(moves[3].override_locked);
  EXPECT_EQ(moves[3].spindle_rev_s, 1.0);
  EXPECT_EQ(moves[5].spindle_rev_s, -1.0);
  EXPECT_FALSE(moves[6].override_locked);
}

TEST(Interpreter, SaysInWhichFeedModeAFeedIsMeant) {
  const auto moves = moves_of("G93 G1 X1 F2\nG95 F.1 S600\nG1 X2\nG94 F60\nA5\nM2\n");
  EXPECT_EQ(moves.at(0).feed_mode, FeedMode::inverse_time);
  // F2 is 2/min, F.1 is mm/rev; A alone at F60 is 1 °/s.
  EXPECT_DOUBLE_EQ(moves.at(0).feed_mm_s, 2.0 / 60.0);
  EXPECT_EQ(moves.at(1).feed_mode, FeedMode::per_revolution);
  EXPECT_DOUBLE_EQ(moves.at(1).feed_mm_s, 0.1);
  EXPECT_DOUBLE_EQ(moves.at(2).feed_mm_s, 1.0);
}

TEST(Interpreter, LeavesDeletedBlocksOutOnlyWhenAsked) {
  EXPECT_EQ(moves_of("/G0 X1\nM2\n").size(), 1U);
  Config config;
  config.block_delete = true;
  EXPECT_EQ(moves_of("/G0 X1\nM2\n", config).size(), 0U);
}

TEST(Interpreter, RefusesAToolThatTheTableHasNot) {
  Config config;
  config.tools = std::vector<Tool>{{.number = 1, .offset = {0, 0, 12.5}, .diameter_mm = 6.0}};
  EXPECT_EQ(reason_of("T2 M6\nM2\n", config), "no_such_tool");
  EXPECT_EQ(moves_of("T1 M6\nG43\nG0 X1\nM2\n", config).at(0).end[2], -12.5);
}

}  // namespace
}  // namespace steadyrest::nc::interpret
