// SPDX-License-Identifier: Apache-2.0
// Cycles of Klartext: the sequences of the manual "Cycle programming", move by move, and
// coordinate transformations.
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

const std::string kDrill =
    "L Z+100 FMAX M3\nCYCL DEF 200 DRILLING ~\n  Q200=+2 ;SET-UP CLEARANCE ~\n  Q201=-15 ;DEPTH ~\n"
    "  Q206=+150 ;FEED RATE FOR PLNGNG ~\n  Q202=+6 ;PLUNGING DEPTH ~\n  Q210=+0.5 ;DWELL AT TOP "
    "~\n"
    "  Q203=+1 ;SURFACE COORDINATE ~\n  Q204=+20 ;2ND SET-UP CLEARANCE ~\n"
    "  Q211=+0.2 ;DWELL TIME AT DEPTH\n";

// 200: infeed, back to the clearance, a dwell there, down to the clearance above the last depth.
TEST(HeidenhainCycles, Drill) {
  expect_twin(kDrill + "L X+30 Y+20 FMAX M99\nL X+80",
              "G90 G0 Z100\nX30 Y20\nZ3\nG1 Z-5 F150\nG0 Z3\nG4 P0.5\nG0 Z-3\nG1 Z-11\nG0 Z3\n"
              "G4 P0.5\nG0 Z-9\nG1 Z-14\nG4 P0.2\nG0 Z21\nG1 X80 F600");
  // In one go where the infeed is 0 or not less than the depth.
  EXPECT_THAT(klartext_ends(2, kDrill + "Q202=0\nL X+30 FMAX M99"),
              ElementsAre(100.0, 100.0, 3.0, -14.0, -14.0, 21.0));
}

TEST(HeidenhainCycles, AreCalledOnceOrAfterEachMove) {
  EXPECT_EQ(klartext_moves(kDrill + "Q202=0\nL X+1 FMAX\nCYCL CALL\nL X+2 FMAX").size(), 7U);
  // M89 until M99: three holes of five moves each at their places, then a move alone.
  EXPECT_EQ(klartext_moves(kDrill + "Q202=0\nL X+1 FMAX M89\nL X+2 FMAX\nM8\nL X+3 FMAX M99\nL X+4"
                                    " FMAX")
                .size(),
            1U + 3U * 5U + 1U);
  EXPECT_THAT(klartext_ends(0, kDrill + "Q202=0\nCYCL CALL POS X+5 Y+6 Z+0"),
              ElementsAre(0.0, 5.0, 5.0, 5.0, 5.0, 5.0));
  EXPECT_EQ(klartext_reason("CYCL CALL"), "no_cycle");
  EXPECT_EQ(klartext_reason(kDrill + "L Z+0 FMAX\nCYCL CALL POS X+5 Y+6 Z+0"), "cycle_position");
  EXPECT_EQ(klartext_reason(kDrill + "CYCL CALL POS X+5 Y+6 Z+3"), "cycle_position");
}

// A parameter that is set directly behind the definition counts; one that it was set from does not.
TEST(HeidenhainCycles, ReadTheirParametersWhenTheyAreCalled) {
  EXPECT_EQ(klartext_ends(2, "Q5 = 7\n" + kDrill + "Q201=-5\nQ202=Q5\nQ5 = 1\nCYCL CALL").at(2),
            -4.0);
}

TEST(HeidenhainCycles, Centre) {
  const std::string cycle =
      "L Z+50 FMAX M3\nCYCL DEF 240 CENTERING ~\nQ200=2 ~\nQ343=0 ~\nQ201=-3 ~\nQ344=-5 "
      "~\nQ206=100 "
      "~\nQ211=0.5 ~\nQ203=+0 ~\nQ204=10\n";
  expect_twin(cycle + "L X+30 FMAX M99", "G90 G0 Z50\nX30\nZ2\nG1 Z-3 F100\nG4 P0.5\nG0 Z10");
  EXPECT_EQ(klartext_reason(cycle + "Q343=1\nCYCL CALL"), "cycle_value");
}

TEST(HeidenhainCycles, Ream) {
  expect_twin(
      "L Z+50 FMAX M3\nCYCL DEF 201 REAMING ~\nQ200=2 ~\nQ201=-15 ~\nQ206=100 ~\nQ211=0.5 ~\n"
      "Q208=250 ~\nQ203=+20 ~\nQ204=30\nL X+30 Y+20 FMAX M99",
      "G90 G0 Z50\nX30 Y20\nZ22\nG1 Z5 F100\nG4 P0.5\nG1 Z22 F250\nG0 Z50");
}

// 203: infeeds 5, 4, 3, then not less than Q205; out of the hole at Q208 after each.
TEST(HeidenhainCycles, DrillWithShrinkingInfeeds) {
  const std::string cycle =
      "L Z+50 FMAX M3\nCYCL DEF 203 UNIVERSAL DRILLING ~\nQ200=2 ~\nQ201=-18 ~\nQ206=150 ~\nQ202=5 "
      "~\n"
      "Q210=0 ~\nQ203=+0 ~\nQ204=2 ~\nQ212=1 ~\nQ213=0 ~\nQ205=3 ~\nQ211=0 ~\nQ208=500 "
      "~\nQ256=0.2\n";
  expect_twin(
      cycle + "CYCL CALL",
      "G90 G0 Z50\nZ2\nG1 Z-5 F150\nZ2 F500\nG0 Z-3\nG1 Z-9 F150\nZ2 F500\nG0 Z-7\n"
      "G1 Z-12 F150\nZ2 F500\nG0 Z-10\nG1 Z-15 F150\nZ2 F500\nG0 Z-13\nG1 Z-18 F150\nZ2 F500");
  EXPECT_EQ(klartext_reason(cycle + "Q213=3\nCYCL CALL"), "cycle_value");
  EXPECT_EQ(klartext_reason(cycle + "Q208=0\nCYCL CALL"), "feed_missing");
}

TEST(HeidenhainCycles, PeckWithAStopDistance) {
  const std::string cycle =
      "L Z+50 FMAX M3\nCYCL DEF 205 UNIVERSAL PECKING ~\nQ200=2 ~\nQ201=-12 ~\nQ206=150 ~\nQ202=5 "
      "~\n"
      "Q203=+0 ~\nQ204=10 ~\nQ212=0 ~\nQ205=3 ~\nQ258=0.5 ~\nQ259=0.5 ~\nQ257=0 ~\nQ256=0.2 ~\n"
      "Q211=0.25 ~\nQ379=0 ~\nQ253=750\n";
  expect_twin(
      cycle + "CYCL CALL",
      "G90 G0 Z50\nZ2\nG1 Z-5 F150\nG0 Z2\nZ-4.5\nG1 Z-10\nG0 Z2\nZ-9.5\nG1 Z-12\nG4 P0.25\n"
      "G0 Z10");
  EXPECT_EQ(klartext_reason(cycle + "Q257=1\nCYCL CALL"), "cycle_value");
}

TEST(HeidenhainCycles, Tap) {
  const std::string floating =
      "L Z+50 FMAX M3\nCYCL DEF 206 TAPPING NEW ~\nQ200=2 ~\nQ201=-20 ~\nQ206=150 ~\nQ211=0.25 ~\n"
      "Q203=+25 ~\nQ204=50\n";
  const auto moves = klartext_moves(floating + "CYCL CALL");
  ASSERT_EQ(moves.size(), 6U);
  EXPECT_EQ(moves[2].end[2], 5.0);
  EXPECT_TRUE(moves[2].override_locked);
  EXPECT_GT(moves[2].spindle_rev_s, 0.0);
  EXPECT_LT(moves[4].spindle_rev_s, 0.0);
  EXPECT_EQ(moves[5].end[2], 75.0);
  // Rigid: the feed is the pitch, a negative one turns left.
  const auto rigid = klartext_moves(
      "L Z+50 FMAX M3\nCYCL DEF 207 RIGID TAPPING ~\nQ200=2 ~\nQ201=-20 ~\nQ239=-1.25 ~\nQ203=+0 "
      "~\n"
      "Q204=2\nCYCL CALL");
  ASSERT_EQ(rigid.size(), 4U);
  EXPECT_EQ(rigid[2].kind, MoveKind::thread);
  EXPECT_EQ(rigid[2].feed_mm_s, 1.25);
  EXPECT_EQ(rigid[2].feed_mode, FeedMode::per_revolution);
  EXPECT_LT(rigid[2].spindle_rev_s, 0.0);
  EXPECT_EQ(rigid[3].end[2], 2.0);
}

// The old cycle 1: from where the tool stands, with t = 0.6 mm.
TEST(HeidenhainCycles, PeckAsOlderControlsDo) {
  expect_twin(
      "L X+10 Y+10 Z+2 FMAX M3\nCYCL DEF 1.0 PECKING\nCYCL DEF 1.1 SET UP 2\nCYCL DEF 1.2 DEPTH "
      "-15\nCYCL DEF 1.3 PECKG 10\nCYCL DEF 1.4 DWELL 0\nCYCL DEF 1.5 F80\nCYCL CALL\nL X+20 "
      "FMAX M99",
      "G90 G0 X10 Y10 Z2\nG1 Z-10 F80\nG0 Z2\nZ-9.4\nG1 Z-15\nG0 Z2\nX20\nG1 Z-10\nG0 Z2\n"
      "Z-9.4\nG1 Z-15\nG0 Z2");
  EXPECT_EQ(klartext_reason("CYCL DEF 1.0 PECKING\nCYCL DEF 1.1 SET UP 2\nCYCL CALL"), "no_cycle");
}

TEST(HeidenhainCycles, DwellAndSetTheTolerance) {
  const auto moves = klartext_moves(
      "CYCL DEF 9.0 DWELL TIME\nCYCL DEF 9.1 V.ZEIT 1.5\nCYCL DEF 32.0 TOLERANCE\nCYCL DEF 32.1 "
      "T0.05\n"
      "CYCL DEF 32.2 HSC-MODE:1 TA5\nL X+1 F100\nCYCL DEF 32.0 TOLERANCE\nCYCL DEF 32.1\nL X+2");
  EXPECT_EQ(moves.at(0).dwell_s, 1.5);
  EXPECT_EQ(moves.at(1).path_tolerance_mm, 0.05);
  EXPECT_EQ(moves.at(2).path_tolerance_mm, 0.0);
}

TEST(HeidenhainCycles, AreRefusedByName) {
  EXPECT_EQ(klartext_reason("CYCL DEF 251 POCKET ~\nQ215=0\n"), "cycle_not_interpreted");
  EXPECT_EQ(klartext_reason("CYCL DEF 14.0 CONTOUR"), "cycle_not_interpreted");
  EXPECT_EQ(klartext_reason(kDrill + "Q201=5\nCYCL CALL"), "cycle_planes");
  EXPECT_EQ(klartext_reason("CYCL DEF 200 DRILLING ~\nQ200=2\nCYCL CALL"), "cycle_value_missing");
  EXPECT_EQ(klartext_reason(kDrill + "Q202=1e-9\nCYCL CALL").empty(), false);
  EXPECT_EQ(klartext_reason(kDrill + "Q202=0.00001\nCYCL CALL"), "out_of_range");
}

// "Coordinate transformation cycles": machine = preset + shift + R·M·position.
TEST(HeidenhainFrames, ShiftRotateAndMirror) {
  const auto machine = [](const Move& move) { return machine_of(move, move.end); };
  auto moves = klartext_moves(
      "CYCL DEF 7.0 DATUM SHIFT\nCYCL DEF 7.1 X+60\nCYCL DEF 7.2 Y+40\nL X+1 Y+2 FMAX\nCYCL DEF "
      "7.0 "
      "DATUM SHIFT\nCYCL DEF 7.1 IX+10\nL X+1 Y+2 FMAX");
  EXPECT_EQ(
      klartext_ends(0, "TRANS DATUM AXIS X+5\nL X+1 FMAX\nTRANS DATUM RESET\nL X+1 FMAX").at(0),
      1.0);
  EXPECT_EQ(klartext_reason("TRANS DATUM TABLE TABLINE5"), "datum_shift");
  EXPECT_EQ(machine(moves.at(0))[0], 61.0);
  EXPECT_EQ(machine(moves.at(0))[1], 42.0);
  EXPECT_EQ(machine(moves.at(1))[0], 71.0);
  // The manual's part: shifted to (65, 65), then turned by 45 degrees each time.
  moves = klartext_moves(
      "CYCL DEF 7.0 DATUM SHIFT\nCYCL DEF 7.1 X+65\nCYCL DEF 7.2 Y+65\nCYCL DEF 10.0 ROTATION\n"
      "CYCL DEF 10.1 IROT+45\nCYCL DEF 10.0 ROTATION\nCYCL DEF 10.1 IROT+45\nL X+10 Y+0 FMAX\n"
      "CYCL DEF 10.0 ROTATION\nCYCL DEF 10.1 ROT+0\nL X+10 Y+0 FMAX");
  EXPECT_NEAR(machine(moves.at(0))[0], 65.0, 1e-12);
  EXPECT_NEAR(machine(moves.at(0))[1], 75.0, 1e-12);
  EXPECT_NEAR(machine(moves.at(1))[0], 75.0, 1e-12);
  // Mirrored X: signs and the direction of arcs change.
  expect_twin(
      "CYCL DEF 8.0 MIRROR IMAGE\nCYCL DEF 8.1 X\nL X+10 Y+0 FMAX\nCC X+0 Y+0\nC X+0 Y+10 DR+ "
      "F100\nL IX+5\nLP PR+10 PA+0\nCYCL DEF 8.0 MIRROR IMAGE\nCYCL DEF 8.1\nL X+10 Y+1",
      "G90 G90.1 G0 X-10 Y0\nG2 X0 Y10 I0 J0 F100\nG1 X-5\nX-10 Y0\nX10 Y1");
}

TEST(HeidenhainFrames, RefuseWhatDependsOnTheirOrder) {
  const std::string rotated = "CYCL DEF 10.0 ROT\nCYCL DEF 10.1 ROT+30\n";
  EXPECT_EQ(klartext_reason(rotated + "CYCL DEF 7.1 X+5"), "frame_order");
  EXPECT_EQ(klartext_reason(rotated + "CYCL DEF 7.1 X+0\nCYCL DEF 7.3 Z+5"), "");
  EXPECT_EQ(klartext_reason(rotated + "CYCL DEF 8.0 M\nCYCL DEF 8.1 X"), "frame_order");
  EXPECT_EQ(klartext_reason("CYCL DEF 8.0 M\nCYCL DEF 8.1 X\n" + rotated), "frame_order");
  EXPECT_EQ(klartext_reason("CYCL DEF 8.0 M\nCYCL DEF 8.1 Z"), "mirror_axis");
  EXPECT_EQ(klartext_reason("CYCL DEF 11.0 SCALING\nCYCL DEF 11.1 SCL0.5"), "scaling");
  EXPECT_EQ(klartext_reason("CYCL DEF 11.0 SCALING\nCYCL DEF 11.1 SCL1"), "");
  EXPECT_EQ(klartext_reason("CYCL DEF 7.0 DATUM SHIFT\nCYCL DEF 7.1 #5"), "datum_table");
  EXPECT_EQ(klartext_reason("CYCL DEF 7.1 X+5\nL IX+1 FMAX"), "frame_incremental");
}

TEST(HeidenhainFrames, TakeAPlaneThatIsNotTilted) {
  EXPECT_EQ(klartext_reason("CYCL DEF 19.0 WORKING PLANE\nCYCL DEF 19.1 A+0 B+0 C+0\nCYCL DEF 19.0 "
                            "WORKING PLANE\nCYCL DEF 19.1"),
            "");
  EXPECT_EQ(klartext_reason("CYCL DEF 19.1 A+0 B+45 C+0"), "tilted_plane");
}

TEST(HeidenhainFrames, ChooseAPreset) {
  Config config = heidenhain();
  config.work_offset[2][0] = 7.0;
  const auto moves = moves_of(
      klartext(
          "CYCL DEF 7.1 X+5\nCYCL DEF 247 DATUM SETTING ~\n  Q339=+3 ;DATUM NUMBER\nL X+1 FMAX"),
      config);
  EXPECT_EQ(moves.at(0).end[0] + moves.at(0).offset[0], 8.0);
  EXPECT_EQ(klartext_reason("CYCL DEF 247 DATUM SETTING ~\nQ339=+12"), "preset");
}

}  // namespace
}  // namespace steadyrest::nc::interpret
