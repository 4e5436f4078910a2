// SPDX-License-Identifier: Apache-2.0
#include <steadyrest/nc/interpret/test/moves.hpp>

namespace steadyrest::nc::interpret {
namespace {

using read::Dialect;

Config in(Dialect dialect) {
  Config config;
  config.dialect = dialect;
  return config;
}

void expect_same(const std::vector<Move>& left, const std::vector<Move>& right) {
  ASSERT_EQ(left.size(), right.size());
  for (std::size_t i = 0; i < left.size(); ++i) {
    EXPECT_EQ(left[i].kind, right[i].kind) << i;
    EXPECT_EQ(left[i].end, right[i].end) << i;
    EXPECT_EQ(left[i].centre_mm, right[i].centre_mm) << i;
    EXPECT_EQ(left[i].turns, right[i].turns) << i;
    EXPECT_EQ(left[i].feed_mm_s, right[i].feed_mm_s) << i;
    EXPECT_EQ(left[i].dwell_s, right[i].dwell_s) << i;
  }
}

TEST(Fanuc, AddsTheExternalOffsetToEveryWorkOffset) {
  Config config = in(Dialect::fanuc);
  config.work_offset[1][2] = 100.0;
  const auto moves = moves_of(
      "G90 G54 G0 Z0\nG91 G10 L2 P0 Z-0.01\nG90\nZ0\nG55 Z0\nG91 G10 L2 P0 Z0.01\nG90 Z0\n"
      "G10 L2 P2 Z50.\nZ0\nM30\n",
      config);
  const auto machine = [&](std::size_t i) { return moves.at(i).end[2] + moves.at(i).offset[2]; };
  // −0.01 is external and adds to both systems; then it is removed; P2 sets only G55.
  EXPECT_DOUBLE_EQ(machine(0), 0.0);
  EXPECT_DOUBLE_EQ(machine(1), -0.01);
  EXPECT_DOUBLE_EQ(machine(2), 99.99);
  EXPECT_DOUBLE_EQ(machine(3), 100.0);
  EXPECT_DOUBLE_EQ(machine(4), 50.0);
}

TEST(Fanuc, TakesP0ForG52OnAHaasAndRefusesIt) {
  Config config = in(Dialect::fanuc);
  config.external_offset = false;
  Kept kept;
  EXPECT_FALSE(run_text("G10 L2 P0 Z1.\nM30\n", config, kept).value().refused.empty());
}

TEST(Sinumerik, SaysTheSameAsLinuxcncInOtherWords) {
  // The same lines in LinuxCNC's words; other tests compare those moves with rs274.
  const auto theirs = moves_of(
      "N10 G17 G71 G90 G94 G0 X=10 Y20 Z5 ; start\nG1 Z-1 F200\nG2 X20 CR=5 F=300\n"
      "G3 I=AC(15) J0 X20 TURN=2 Z-3\nG4 F1.5\nG0 X=IC(5) Y=AC(0)\nG91 X1 Y=AC(7)\nM30\n",
      in(Dialect::sinumerik));
  const auto ours = moves_of(
      "G17 G21 G90 G94 G0 X10 Y20 Z5\nG1 Z-1 F200\nG2 X20 R5 F300\nG3 I-5 J0 X20 P3 Z-3\nG4 P1.5\n"
      "G0 X25 Y0\nX26 Y7\nM2\n");
  expect_same(theirs, ours);
}

TEST(Sinumerik, KeepsTheFeedMetricInG70ButNotInG700) {
  // 60 mm/min is 1 mm/s; 60 in/min is 25.4 mm/s.
  EXPECT_DOUBLE_EQ(moves_of("G70 G1 X1 F60\nM30\n", in(Dialect::sinumerik)).at(0).feed_mm_s, 1.0);
  EXPECT_DOUBLE_EQ(moves_of("G700 G1 X1 F60\nM30\n", in(Dialect::sinumerik)).at(0).feed_mm_s, 25.4);
}

TEST(Sinumerik, SuppressesOffsetsForTheBlockOfSupaOnly) {
  Config config = in(Dialect::sinumerik);
  config.work_offset[0][0] = 100.0;
  const auto moves = moves_of("G54 G0 X0\nSUPA X5\nX1\nG500 X2\nM30\n", config);
  // X5 of the machine is X−95 in G54.
  EXPECT_EQ(moves.at(1).end[0], -95.0);
  EXPECT_EQ(moves.at(2).end[0], 1.0);
  EXPECT_EQ(moves.at(3).end[0] + moves.at(3).offset[0], 2.0);
}

TEST(Sinumerik, NamesTheToolInTheEvent) {
  Kept kept;
  ASSERT_TRUE(run_text("T=\"DRILL 8.5\"\nM6\nM30\n", in(Dialect::sinumerik), kept).has_value());
  EXPECT_EQ(kept.events.at(1).kind, EventKind::tool_change);
}

TEST(Sinumerik, RoundsCornersWithinAdisOnlyInContinuousMode) {
  const auto moves =
      moves_of("G641 ADIS=0.5 G1 X1 F100\nG9 X2\nG60 X3\nM30\n", in(Dialect::sinumerik));
  // ADIS belongs to G641; G9 and G60 stop.
  EXPECT_EQ(moves.at(0).path_tolerance_mm, 0.5);
  EXPECT_EQ(moves.at(1).path_mode, PathMode::exact_stop);
  EXPECT_EQ(moves.at(2).path_mode, PathMode::exact_stop);
}

TEST(Fanuc, ReadsNumbersWithoutPointAsTheOptionSays) {
  EXPECT_EQ(moves_of("G0 X100\nM30\n", in(Dialect::fanuc)).at(0).end[0], 100.0);
  Config config = in(Dialect::fanuc);
  config.decimal_rule = DecimalRule::least_increment;
  // IS-B: 100 increments are 0.1 mm, and 10000 of 0.0001 in one inch.
  EXPECT_EQ(moves_of("G0 X100 Y100.\nM30\n", config).at(0).end[0], 0.1);
  EXPECT_EQ(moves_of("G0 X100 Y100.\nM30\n", config).at(0).end[1], 100.0);
  EXPECT_DOUBLE_EQ(moves_of("G20\nG0 X10000\nM30\n", config).at(0).end[0], 25.4);
}

TEST(Fanuc, DwellsInMillisecondsOrSeconds) {
  const auto moves =
      moves_of("G4 P500\nG4 X1.5\nG82 Z-1. R1. P250 F60.\nM30\n", in(Dialect::fanuc));
  EXPECT_EQ(moves.at(0).dwell_s, 0.5);
  EXPECT_EQ(moves.at(1).dwell_s, 1.5);
  EXPECT_EQ(moves.at(5).dwell_s, 0.25);
}

TEST(Fanuc, TakesAxisWordsForG28BesideG0) {
  const auto moves = moves_of("G0 X1 Y2 Z3\nG0 G91 G28 Z0\nG90 X5\nM30\n", in(Dialect::fanuc));
  ASSERT_EQ(moves.size(), 4U);
  EXPECT_EQ(moves[2].end[2], 0.0);
  // G28 Z0 in G91 goes via Z3 to the reference point, in Z only.
  EXPECT_EQ(moves[2].end[0], 1.0);
  EXPECT_EQ(moves[3].kind, MoveKind::rapid);
}

TEST(Fanuc, KeepsCycleWordsFromCycleToCycleAndReturnsToTheInitialLevel) {
  const auto moves =
      moves_of("G0 Z10.\nG81 X1. Z-5. R2. F60.\nG82 X2. P100\nG80\nM30\n", in(Dialect::fanuc));
  // The rapid, four moves of G81, five of G82 with its dwell.
  ASSERT_EQ(moves.size(), 10U);
  EXPECT_EQ(moves[4].end[2], 10.0);
  EXPECT_EQ(moves[7].end[2], -5.0);
  EXPECT_EQ(moves[8].dwell_s, 0.1);
}

TEST(Fanuc, RefusesWhatLathesReadOtherwise) {
  EXPECT_EQ(reason_of("G50 S2000\nM30\n", in(Dialect::fanuc)), "lathe_code");
  EXPECT_EQ(reason_of("G0 U1.\nM30\n", in(Dialect::fanuc)), "lathe_word");
}

}  // namespace
}  // namespace steadyrest::nc::interpret
