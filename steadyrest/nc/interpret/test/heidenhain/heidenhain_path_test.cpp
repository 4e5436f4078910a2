// SPDX-License-Identifier: Apache-2.0
// Path functions of Klartext against the same moves in plain G code. Other tests compare those with
// rs274.
#include <cmath>

#include <gmock/gmock.h>

#include <steadyrest/nc/interpret/test/heidenhain/heidenhain.hpp>

namespace steadyrest::nc::interpret {
namespace {

using test::expect_twin;
using test::heidenhain;
using test::klartext;
using test::klartext_ends;
using test::klartext_moves;
using test::klartext_reason;
using testing::ElementsAre;

TEST(HeidenhainPath, MovesAlongLines) {
  expect_twin(
      "L Z+100 R0 FMAX M3\nL X-10,5 Y+0 FMAX\nL IZ-105 F200\nL X+20 IY+3 FAUTO\nL X+30 FMAX M5\n"
      "L Y+7",
      "G90 G0 Z100\nX-10.5 Y0\nG1 Z-5 F200\nX20 Y3 F600\nG0 X30\nG1 Y7");
}

// "Programming contours", "Circle center CC", "Circular path C": full circles and both directions.
TEST(HeidenhainPath, MovesAlongCircles) {
  expect_twin("L X+45 Y+25 FMAX\nCC X+25 Y+25\nC X+45 Y+25 DR+ F100\nC X+25 Y+5 DR-",
              "G90 G90.1 G0 X45 Y25\nG3 X45 Y25 I25 J25 F100\nG2 X25 Y5 I25 J25");
  expect_twin("L X+40 Y+40 FMAX\nCR X+70 Y+40 R+20 DR- F100\nCR X+40 Y+40 R-20 DR-",
              "G90 G0 X40 Y40\nG2 X70 Y40 R20 F100\nG2 X40 Y40 R-20");
  expect_twin("L X+10 Y+0 FMAX\nCC IX-10 IY+0\nC X+0 Y+10 DR+ F100\nCC\nL X+3",
              "G90 G90.1 G0 X10 Y0\nG3 X0 Y10 I0 J0 F100\nG1 X3");
}

// Helix of the manual: 5 turns and a start and an end that lie apart.
TEST(HeidenhainPath, MovesAlongHelices) {
  expect_twin("L X+40 Y+25 Z+0 FMAX\nCC X+40 Y+35\nCP IPA-1800 IZ+5 DR- F100",
              "G90 G90.1 G0 X40 Y25 Z0\nG2 X40 Y25 Z5 I40 J35 P5 F100");
  expect_twin("L X+50 Y+35 Z+0 FMAX\nCC X+40 Y+35\nCP IPA+450 Z-3 DR+ F100",
              "G90 G90.1 G0 X50 Y35 Z0\nG3 X40 Y45 Z-3 I40 J35 P2 F100");
  expect_twin("L X+50 Y+35 FMAX\nCC X+40 Y+35\nCP PA+180 DR- F100\nCP PA+180 DR-",
              "G90 G90.1 G0 X50 Y35\nG2 X30 Y35 I40 J35 F100\nG2 X30 Y35 I40 J35");
}

// "Straight line LP": a pole, an angle and a length, either of them incremental.
TEST(HeidenhainPath, MovesInPolarCoordinates) {
  const auto x = klartext_ends(
      0, "L X+0 Y+0 F100\nCC X+45 Y+25\nLP PR+30 PA+0\nLP PA+60\nLP IPA+60\nLP PA+180\nLP IPR-10");
  const auto y = klartext_ends(
      1, "L X+0 Y+0 F100\nCC X+45 Y+25\nLP PR+30 PA+0\nLP PA+60\nLP IPA+60\nLP PA+180\nLP IPR-10");
  const std::vector<double> wanted_x = {0, 75, 60, 30, 15, 25};
  const double high = 25.0 + 15.0 * std::sqrt(3.0);
  const std::vector<double> wanted_y = {0, 25, high, high, 25, 25};
  ASSERT_EQ(x.size(), wanted_x.size());
  for (std::size_t i = 0; i < x.size(); ++i) {
    EXPECT_NEAR(x[i], wanted_x[i], 1e-12) << i;
    EXPECT_NEAR(y[i], wanted_y[i], 1e-12) << i;
  }
}

// The manual's example: from (25, 30) along +45 degrees, CT to (45, 20).
TEST(HeidenhainPath, ContinuesTangentially) {
  const auto moves = klartext_moves("L X+0 Y+25 FMAX\nL X+25 Y+30 F300\nCT X+45 Y+20\nL Y+0");
  const Move& arc = moves.at(2);
  const double radius =
      std::hypot(arc.start[0] - arc.centre_mm[0], arc.start[1] - arc.centre_mm[1]);
  EXPECT_NEAR(std::hypot(45.0 - arc.centre_mm[0], 20.0 - arc.centre_mm[1]), radius, 1e-12);
  // The radius at the start is normal to the line before it, which runs by (25, 5).
  EXPECT_NEAR((arc.centre_mm[0] - 25.0) * 25.0 + (arc.centre_mm[1] - 30.0) * 5.0, 0.0, 1e-9);
  EXPECT_EQ(arc.turns, -1);
  // A half circle about a known centre, from a tangent along +X.
  expect_twin("L X+0 Y+0 FMAX\nL X+10 F100\nCT X+10 Y+20\nCT X+10 Y-20",
              "G90 G90.1 G0 X0 Y0\nG1 X10 F100\nG3 X10 Y20 I10 J10\nG3 X10 Y-20 I10 J0");
  expect_twin("L X+0 Y+0 FMAX\nL X+10 F100\nCC X+10 Y+0\nCTP PR+20 PA+90",
              "G90 G90.1 G0 X0 Y0\nG1 X10 F100\nG3 X10 Y20 I10 J10");
}

// The manual's example without compensation: a corner that is not right-angled. The tangent length
// is r·tan(turn/2), and the centre is the radius off both lines.
TEST(HeidenhainPath, RoundsTheManualsCorner) {
  const auto moves = klartext_moves("L X+10 Y+40 R0 F300 M3\nL X+40 Y+25\nRND R5 F100\nL X+10 Y+5");
  ASSERT_EQ(moves.size(), 4U);
  const double turn = std::atan2(-20, -30) - std::atan2(-15, 30) + 2 * 3.14159265358979323846;
  const double back = 5.0 * std::tan(0.5 * (2 * 3.14159265358979323846 - turn));
  EXPECT_NEAR(std::hypot(40 - moves[1].end[0], 25 - moves[1].end[1]), back, 1e-9);
  EXPECT_NEAR(std::hypot(40 - moves[2].end[0], 25 - moves[2].end[1]), back, 1e-9);
  const auto& centre = moves[2].centre_mm;
  EXPECT_NEAR(std::abs((centre[0] - 40) * 15 + (centre[1] - 25) * 30) / std::hypot(30, 15), 5,
              1e-9);
  EXPECT_NEAR(std::abs((centre[0] - 40) * 20 - (centre[1] - 25) * 30) / std::hypot(30, 20), 5,
              1e-9);
  EXPECT_EQ(moves[2].turns, -1);
  EXPECT_NEAR(moves[2].feed_mm_s, 100.0 / 60.0, 1e-12);
  EXPECT_NEAR(moves[3].feed_mm_s, 300.0 / 60.0, 1e-12);
}

// A right angle: the rounding begins and ends its radius off the corner.
TEST(HeidenhainPath, RoundsAndChamfersCorners) {
  expect_twin(
      "L X+10 Y+40 FMAX\nL X+40 Y+40 F300\nRND R5 F100\nL Y+10\nCHF 4\nL X+0",
      "G90 G90.1 G0 X10 Y40\nG1 X35 F300\nG2 X40 Y35 I35 J35 F100\nG1 Y14 F300\nX36 Y10\nX0");
  // Between a line and a circle about (0, 0) of radius 10: the rounding of radius 2 lies at 8 from
  // its centre and at 2 from the line.
  const double x = std::sqrt(8.0 * 8.0 - 2.0 * 2.0);
  const auto moves =
      klartext_moves("L X+0 Y+0 FMAX\nL X+10 F300\nRND R2\nCC X+0 Y+0\nC X+0 Y+10 DR+\nL Y+20");
  ASSERT_EQ(moves.size(), 5U);
  EXPECT_NEAR(moves[1].end[0], x, 1e-12);
  EXPECT_NEAR(moves[2].centre_mm[0], x, 1e-12);
  EXPECT_NEAR(moves[2].centre_mm[1], 2.0, 1e-12);
  EXPECT_NEAR(moves[2].end[0], x * 10.0 / 8.0, 1e-12);
  EXPECT_NEAR(moves[2].end[1], 2.0 * 10.0 / 8.0, 1e-12);
  EXPECT_EQ(moves[2].turns, 1);
}

TEST(HeidenhainPath, TakesTheFeedOfItsUnit) {
  expect_twin("L X+1 FAUTO\nL Y+1 F100", "G90 G20\nG1 X1 F60\nY1 F10", "INCH");
}

TEST(HeidenhainPath, WorksInThePlaneOfTheToolAxis) {
  expect_twin("TOOL CALL 2 Y S500 F100\nL X+0 Y+0 Z+10 FMAX\nCC X+0 Z+0\nC X+10 Z+0 DR+ FAUTO",
              "G90 G90.1 G18 G0 X0 Y0 Z10\nG3 X10 Z0 I0 K0 F100");
  expect_twin("TOOL CALL 2 X S500 F100\nL X+0 Y+10 Z+0 FMAX\nCC Y+0 Z+0\nCP PA+90 DR+ FAUTO",
              "G90 G90.1 G19 G0 X0 Y10 Z0\nG3 Y0 Z10 J0 K0 F100");
}

TEST(HeidenhainPath, GoesToMachineCoordinates) {
  Config config = heidenhain();
  config.work_offset[0] = {10.0, 20.0, 30.0};
  const auto moves = moves_of(klartext("L X+5 Y+5 Z+5 FMAX\nL Z-1 R0 FMAX M91"), config);
  EXPECT_EQ(moves.at(1).end[2], -31.0);
  EXPECT_EQ(moves.at(1).machine_axes, 4U);
}

// M5 and M9 act at the end of their block.
TEST(HeidenhainPath, StopsTheSpindleBehindTheMove) {
  Kept kept;
  ASSERT_TRUE(
      run_text(klartext("L X+1 FMAX M13\nL X+2 FMAX M5"), heidenhain(), kept)->refused.empty());
  EXPECT_NE(kept.moves.at(1).spindle_rev_s, 0.0);
  EXPECT_EQ(kept.events.back().kind, EventKind::end);
  EXPECT_EQ(kept.events.at(kept.events.size() - 2).value, 0.0);
}

TEST(HeidenhainPath, RefusesWhatIsNotCertain) {
  EXPECT_EQ(klartext_reason("L X+1 Y+1 RL F100"), "cutter_comp");
  EXPECT_EQ(klartext_reason("C X+1 Y+1 DR+ F100"), "pole_missing");
  EXPECT_EQ(klartext_reason("CC X+1 Y+1\nC X+1 Y+2 F100"), "arc_direction");
  EXPECT_EQ(klartext_reason("CC X+1"), "pole");
  EXPECT_EQ(klartext_reason("CT X+1 Y+2 F100"), "tangent");
  EXPECT_EQ(klartext_reason("L X+5 F100\nCT X+9 Y+0"), "tangent");
  EXPECT_EQ(klartext_reason("CC X+0 Y+5\nCP IPA+90 DR- F100"), "arc_direction");
  EXPECT_EQ(klartext_reason("CC X+0 Y+5\nC X+0 Y+10 DR- FMAX"), "rapid_arc");
  EXPECT_EQ(klartext_reason("RND R5"), "corner");
  EXPECT_EQ(klartext_reason("L X+5 F100\nRND R5"), "corner");
  EXPECT_EQ(klartext_reason("L X+5 F100\nRND R5\nL Y+2"), "corner");
  EXPECT_EQ(klartext_reason("L X+5 F100\nRND R1\nL X+9"), "corner");
  EXPECT_EQ(klartext_reason("L X+5 F100\nRND R1\nL Y+9 FMAX"), "corner");
  EXPECT_EQ(klartext_reason("L X+5 F100\nRND R1\nL Z+9 Y+9"), "corner");
  EXPECT_EQ(klartext_reason("L X+5 F100\nCHF 1\nM30"), "corner");
  EXPECT_EQ(klartext_reason("L X+5 FAUTO M140 MB MAX"), "m_code_not_interpreted");
  EXPECT_EQ(klartext_reason("M42"), "unknown_m_code");
  EXPECT_EQ(klartext_reason("L X+5 Q+3"), "unknown_word");
}

}  // namespace
}  // namespace steadyrest::nc::interpret
