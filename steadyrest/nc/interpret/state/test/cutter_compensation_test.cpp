// SPDX-License-Identifier: Apache-2.0
#include <cmath>
#include <string>

#include <steadyrest/nc/interpret/test/moves.hpp>

// Expected values are rs274's output (LinuxCNC 2.9) for the same lines. The closed forms behind
// some of them:
// - arcs that meet: circles of radius 7 about (25, 20) and (35, 20) meet at X30, 20 + √(49 − 25);
// the line Y22 meets the second at 35 + √(49 − 4).
// - entry on an arc: the centre on Y10 that is as far from (0, 0) as from (12, 10): 100/24 less
// than 6.
// - tangent corners: 10·tan 0.05 = 0.5004: the bound lies between 0.5 and 0.501, on both sides.
namespace steadyrest::nc::interpret {
namespace {

void expect_end(const Move& move, MoveKind kind, double x, double y, double z = 0.0) {
  EXPECT_EQ(move.kind, kind);
  EXPECT_NEAR(move.end[0], x, kHalfDigit);
  EXPECT_NEAR(move.end[1], y, kHalfDigit);
  EXPECT_NEAR(move.end[2], z, kHalfDigit);
}

TEST(CutterCompensation, MeetsAtConcaveCornersAndLeavesStraightBehindG40) {
  const auto moves = moves_of("F100\nG41.1 D4\nG1 X10\nX20 Y5\nX20 Y20\nX0\nG40\nG1 X0 Y0\nM2\n");
  ASSERT_EQ(moves.size(), 5U);
  // 10 − 2·tan(φ/2) at a corner of φ = atan ½; at X18 the contour is at Y4, its offset 2/cos φ
  // above.
  expect_end(moves[0], MoveKind::linear, 9.5279, 2.0);
  expect_end(moves[1], MoveKind::linear, 18.0, 6.2361);
  expect_end(moves[2], MoveKind::linear, 18.0, 18.0);
  expect_end(moves[3], MoveKind::linear, 0.0, 18.0);
  expect_end(moves[4], MoveKind::linear, 0.0, 0.0);
}

// The corner plus 2 mm along the normal of the next line, (5, 10)/√125.
TEST(CutterCompensation, GoesAroundConvexCornersOnAnArcAndInRapidsOnAChord) {
  const auto cutting = moves_of("F100\nG41 G1 X20 D1\nX10 Z5\nM2\n", [] {
    Config config;
    config.tools = {Tool{.number = 1, .offset = {}, .diameter_mm = 2.54}};
    return config;
  }());
  ASSERT_EQ(cutting.size(), 3U);
  expect_end(cutting[1], MoveKind::arc, 20.0, -1.27);
  EXPECT_EQ(cutting[1].turns, -1);
  EXPECT_EQ(cutting[1].centre_mm[0], 20.0);
  expect_end(cutting[2], MoveKind::linear, 10.0, -1.27, 5.0);
  const auto rapid = moves_of("G41.1 D4\nG0 X10\nX20 Y-5\nX20 Y-20\nM2\n");
  ASSERT_EQ(rapid.size(), 5U);
  expect_end(rapid[1], MoveKind::rapid, 10.8944, 1.7889);
  expect_end(rapid[2], MoveKind::rapid, 20.8944, -3.2111);
}

TEST(CutterCompensation, ChangesTheRadiusOfArcsAndCutsThemWhereTheyMeet) {
  const auto moves = moves_of(
      "F100\nG41.1 D4\nG1 X10\nG3 X20 Y10 J10\nG1 X20 Y20\nG2 X30 Y20 I5\nX40 Y20 R5\nG1 "
      "X50\nM2\n");
  ASSERT_EQ(moves.size(), 6U);
  expect_end(moves[1], MoveKind::arc, 18.0, 10.0);
  expect_end(moves[3], MoveKind::arc, 30.0, 24.8990);
  EXPECT_EQ(moves[3].centre_mm[0], 25.0);
  expect_end(moves[4], MoveKind::arc, 41.7082, 22.0);
}

TEST(CutterCompensation, EntersOnAnArcOfANewCentre) {
  const auto moves = moves_of("F100\nG42.1 D4\nG3 X10 Y10 R10\nX0 Y20 R10\nM2\n");
  ASSERT_EQ(moves.size(), 2U);
  expect_end(moves[0], MoveKind::arc, 12.0, 10.0);
  EXPECT_NEAR(moves[0].centre_mm[0], 1.8333, kHalfDigit);
  expect_end(moves[1], MoveKind::arc, 0.0, 22.0);
}

TEST(CutterCompensation, PassesChangesOfDirectionUpToATwentiethOfARadian) {
  EXPECT_EQ(moves_of("F9 G41.1 D4\nG1 X10\nX20 Y-0.5\nM2\n").size(), 2U);
  EXPECT_EQ(moves_of("F9 G41.1 D4\nG1 X10\nX20 Y-0.501\nM2\n").size(), 3U);
  EXPECT_NEAR(moves_of("F9 G41.1 D4\nG1 X10\nX20 Y0.5\nM2\n").at(0).end[0], 10.0, 1e-12);
  EXPECT_NEAR(moves_of("F9 G41.1 D4\nG1 X10\nX20 Y0.501\nM2\n").at(0).end[0], 9.9499, kHalfDigit);
}

TEST(CutterCompensation, KeepsLineFeedAndSpindleOfTheBlockThatAMoveComesFrom) {
  Kept kept;
  const auto report = run_text(
      "F60 S60 M3\nG41.1 D4\nG1 X10\nG1 Z-1 F120\nM5\nG1 Y10 F180\nG40\nG1 X0\nM2\n", {}, kept);
  ASSERT_TRUE(report.has_value());
  ASSERT_TRUE(report->refused.empty());
  ASSERT_EQ(kept.moves.size(), 4U);
  EXPECT_EQ(kept.moves[0].line, 3U);
  EXPECT_EQ(kept.moves[0].feed_mm_s, 1.0);
  EXPECT_EQ(kept.moves[0].spindle_rev_s, 1.0);
  EXPECT_EQ(kept.moves[1].line, 4U);
  EXPECT_EQ(kept.moves[1].feed_mm_s, 2.0);
  EXPECT_EQ(kept.moves[2].line, 6U);
  EXPECT_EQ(kept.moves[2].spindle_rev_s, 0.0);
  expect_end(kept.moves[0], MoveKind::linear, 8.0, 2.0);
  expect_end(kept.moves[1], MoveKind::linear, 8.0, 2.0, -1.0);
  for (std::size_t i = 1; i < kept.moves.size(); ++i) {
    EXPECT_EQ(kept.moves[i].start, kept.moves[i - 1].end) << i;
  }
}

/// The value of `what` after the given line of a compensated contour; nothing where it is refused.
std::vector<double> held(const std::string& line, const std::string& what) {
  std::string text =
      "G21 G17 G90 G64\nG92 X1 Y2\nG10 L2 P1 X100 Y200 R30\nF100\nG0 X0 Y0\n"
      "G41.1 D4\nG1 X10 Y0 Z1\nG1 X10 Y10\nG3 X0 Y20 I-10\nG91 G1 X-5\nG90\nG40\n"
      "G1 X0 Y0\nG0 X#1\nM2\n";
  text.insert(text.find(line) + line.size(), "#1=" + what + "\n");
  const auto moves = moves_of(text);
  return moves.empty() ? std::vector<double>{} : std::vector{moves.back().end[0]};
}

// Both #<_x> and #<_abs_x> are the tool centre, as rs274 shows with (DEBUG,#<_x> #<_abs_x>).
TEST(CutterCompensation, NamesShowTheToolsCentreInWorkAndMachineCoordinates) {
  const struct {
    const char* behind;
    double x, y, abs_x, abs_y;
  } cases[] = {{"G0 X0 Y0\n", 0.0, 0.0, 100.133975, 197.767949},
               {"G41.1 D4\n", 0.0, 0.0, 100.133975, 197.767949},
               {"G1 X10 Y0 Z1\n", 10.0, 2.0, 107.794229, 204.5},
               {"G1 X10 Y10\n", 8.0, 10.0, 102.062178, 210.428203},
               {"G3 X0 Y20 I-10\n", 0.0, 18.0, 91.133975, 213.356406},
               {"G91 G1 X-5\n", -5.0, 18.0, 86.803848, 210.856406},
               {"G40\n", -5.0, 20.0, 85.803848, 212.588457}};
  for (const auto& one : cases) {
    const std::pair<const char*, double> names[] = {
        {"#<_x>", one.x}, {"#<_y>", one.y}, {"#<_abs_x>", one.abs_x}, {"#<_abs_y>", one.abs_y}};
    for (const auto& [name, value] : names) {
      const auto got = held(one.behind, name);
      ASSERT_EQ(got.size(), 1U);
      EXPECT_NEAR(got.front(), value, 1e-6) << one.behind << name;
    }
  }
}

// The numbers always exist but cannot be read from G41 to G40.
TEST(CutterCompensation, NumbersOfThePositionExistButAreNotRead) {
  EXPECT_EQ(held("G40\n", "#5421"), std::vector{20.0});
  for (const char* number : {"#5420", "#[5419+1]", "#5428"}) {
    EXPECT_EQ(reason_of("F100\nG41.1 D4\n#1=" + std::string{number} + "\nG1 X9\nG40\nM2\n"),
              "position_in_cutter_comp");
    for (const char* behind : {"G0 X0 Y0\n", "G1 X10 Y10\n", "G40\n"}) {
      EXPECT_EQ(held(behind, "EXISTS[" + std::string{number} + "]"), std::vector{1.0});
    }
  }
  EXPECT_EQ(held("G1 X10 Y10\n", "EXISTS[#6000]"), std::vector{0.0});
}

TEST(CutterCompensation, ANegativeDiameterChangesTheSide) {
  const auto moves = moves_of("F100\nG41.1 D-2\nG1 X10 Z5\nX20\nM2\n");
  expect_end(moves.at(0), MoveKind::linear, 10.0, -1.0, 5.0);
}

TEST(CutterCompensation, ShiftsALatheToolByItsEdge) {
  const auto moves = moves_of("F100\nG18 G41.1 D2 L1\nG1 X10 Z5\nX20\nM2\n");
  // Concave corner at Z4 X10.2361 for the nose's centre; orientation 1 shifts it by −1 in X and +1
  // in Z.
  EXPECT_NEAR(moves.at(0).end[0], 9.2361, kHalfDigit);
  EXPECT_NEAR(moves.at(0).end[2], 5.0, kHalfDigit);
  EXPECT_NEAR(moves.at(1).end[0], 19.0, kHalfDigit);
}

TEST(CutterCompensation, HoldsBackABoundedNumberOfMoves) {
  std::string text = "F100\nG41.1 D4\nG1 X10\n";
  for (int i = 0; i < 5000; ++i) {
    text += i % 2 == 0 ? "G1 Z1\n" : "G1 Z0\n";
  }
  EXPECT_EQ(reason_of(text + "G1 X20\nM2\n"), "cutter_comp_queue");
}

}  // namespace
}  // namespace steadyrest::nc::interpret
