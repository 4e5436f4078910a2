// SPDX-License-Identifier: Apache-2.0
#include <string>
#include <vector>

#include <gmock/gmock.h>

#include <steadyrest/nc/interpret/test/moves.hpp>

// Series 30i operator's manual, machining centre system: G53 is a one-shot rapid, canned cycles are
// group 09 and leave group 01 as it was, and their words are kept for the row.
namespace steadyrest::nc::interpret {
namespace {

using testing::ElementsAre;

const Config kFanuc = [] {
  Config config;
  config.dialect = read::Dialect::fanuc;
  return config;
}();

std::vector<MoveKind> kinds_of(const std::string& text) {
  std::vector<MoveKind> kinds;
  for (const Move& move : moves_of(text, kFanuc)) {
    kinds.push_back(move.kind);
  }
  return kinds;
}

std::string fault_of(const std::string& text) {
  return reason_of("G21 G90 G17 G0 X0 Y0 Z10.\n" + text + "\nM30\n", kFanuc);
}

constexpr auto kRapid = MoveKind::rapid;
constexpr auto kLinear = MoveKind::linear;
constexpr auto kArc = MoveKind::arc;

TEST(FanucMachineFrame, IsAtRapidTraverseWhateverIsInForce) {
  EXPECT_THAT(kinds_of("G1 X1. F100\nG53 Z5.\nX2.\nM30\n"), ElementsAre(kLinear, kRapid, kLinear));
  EXPECT_THAT(kinds_of("G2 X2. I1. F100\nG53 Z5.\nX4. I1.\nM30\n"),
              ElementsAre(kArc, kRapid, kArc));
  EXPECT_THAT(kinds_of("G53 Z5.\nM30\n"), ElementsAre(kRapid)) << "with nothing in force";
}

TEST(FanucMachineFrame, LetsAMotionWordOfItsBlockSetTheModeOnly) {
  EXPECT_THAT(kinds_of("G0 X1.\nG53 G1 Z5. F100\nX2.\nM30\n"),
              ElementsAre(kRapid, kRapid, kLinear));
  EXPECT_THAT(kinds_of("G1 X1. F9\nG0 G53 Z5.\nX2.\nM30\n"), ElementsAre(kLinear, kRapid, kRapid));
}

TEST(FanucMachineFrame, NeedsNoFeedAndMayBeAlone) {
  EXPECT_THAT(kinds_of("G53 G1 X1.\nM30\n"), ElementsAre(kRapid));
  EXPECT_THAT(kinds_of("G53\nG1 X1. F10\nM30\n"), ElementsAre(kLinear));
}

TEST(FanucMachineFrame, IsRefusedInG91AndInACycle) {
  EXPECT_EQ(fault_of("G91 G53 Z0"), "g53_incremental");
  EXPECT_EQ(fault_of("G81 X1. Z-1. R2. F9\nG53 Z0"), "g53_in_cycle");
  EXPECT_EQ(fault_of("G81 X1. Z-1. R2. F9\nG80 G53 Z0"), "");
  EXPECT_EQ(fault_of("G53 G2 X0 I1."), "two_users_of_axis_words");
}

TEST(FanucCycleEnd, BringsBackTheMotionWordFromBeforeTheCycles) {
  const std::string holes = "G81 X1. Z-1. R2. F60\nG82 X2.\nG80\n";
  EXPECT_EQ(kinds_of("G0 Z9.\n" + holes + "Z20.\nM30\n").back(), kRapid);
  EXPECT_EQ(kinds_of("G1 Z9. F60\n" + holes + "Z20.\nM30\n").back(), kLinear);
  EXPECT_EQ(kinds_of("G0 Z9.\n" + holes + "G1 Z20.\nX1.\nM30\n").back(), kLinear);
  // G53 and G28 between do not change it, a motion word beside them does.
  EXPECT_EQ(kinds_of("G1 Z9. F60\n" + holes + "G53 Z0\nX9.\nM30\n").back(), kLinear);
  EXPECT_EQ(kinds_of("G1 Z9. F60\n" + holes + "G0 G28 Z9.\nX9.\nM30\n").back(), kRapid);
}

TEST(FanucCycleEnd, MovesByItWithAxisWordsInItsBlock) {
  const std::string holes = "G81 X1. Z-1. R2. F60\n";
  EXPECT_EQ(kinds_of("G0 Z9.\n" + holes + "G80 Z20.\nM30\n").back(), kRapid);
  EXPECT_EQ(kinds_of("G1 Z9. F60\n" + holes + "G80 Z20.\nM30\n").back(), kLinear);
  EXPECT_EQ(kinds_of("G0 Z9.\n" + holes + "G80 G91 G28 Z0\nG90 X5.\nM30\n").back(), kRapid);
  EXPECT_EQ(reason_of("G80 Z20.\nM30\n", kFanuc), "no_motion_mode");
}

TEST(FanucReferencePoint, HasFourOfThem) {
  Config config = kFanuc;
  config.home[1][2] = 100.0;
  config.home[2][2] = 200.0;
  config.home[3][2] = 300.0;
  const auto z = [&](const std::string& word) {
    return moves_of("G21 G91 G30 " + word + " Z0\nM30\n", config).back().end[2];
  };
  EXPECT_EQ(z(""), 100.0);
  EXPECT_EQ(z("P2"), 100.0);
  EXPECT_EQ(z("P3"), 200.0);
  EXPECT_EQ(z("P4"), 300.0);
  EXPECT_EQ(fault_of("G91 G30 P1 Z0"), "out_of_range");
  EXPECT_EQ(fault_of("G91 G30 P5 Z0"), "out_of_range");
  EXPECT_EQ(fault_of("G91 G28 P2 Z0"), "unused_word");
  EXPECT_EQ(reason_of("G91 G30 P2 Z0\nM2\n"), "unused_word") << "linuxcnc";
}

TEST(FanucCycles, KeepQAndPForTheRowWhetherTheyUseThemOrNot) {
  EXPECT_EQ(kinds_of("G0 Z9.\nG82 X1. Z-5. R2. F60 Q3.\nM30\n"),
            kinds_of("G0 Z9.\nG82 X1. Z-5. R2. F60\nM30\n"));
  for (const std::string cycle : {"G73", "G81", "G82", "G83", "G85", "G86", "G89"}) {
    EXPECT_EQ(fault_of("M3 S9\n" + cycle + " X1. Z-5. R2. F60 Q3. P100"), "") << cycle;
  }
  // The pecks of G83 are the Q of the G81 before it; so is the dwell of G82.
  EXPECT_EQ(kinds_of("G0 Z9.\nG81 X1. Z-5. R2. F60 Q3.\nG83 X2.\nM30\n"),
            kinds_of("G0 Z9.\nG81 X1. Z-5. R2. F60\nG83 X2. Q3.\nM30\n"));
  const auto moves = moves_of("G0 Z9.\nG81 X1. Z-5. R2. F60 P1500\nG82 X2.\nM30\n", kFanuc);
  EXPECT_EQ(moves.at(moves.size() - 2).dwell_s, 1.5);
}

TEST(FanucCycles, RefuseWordsWithAnotherMeaningOnSomeControls) {
  EXPECT_EQ(fault_of("M3 S9\nG84 X1. Z-5. R2. Q1. F60"), "g_code_not_interpreted");
  EXPECT_EQ(fault_of("G81 X1. Z-5. R2. F60 I1."), "unused_word");
  EXPECT_EQ(fault_of("G1 X1. F60 Q1."), "unused_word");
}

TEST(FanucCycles, StoreTheirWordsAloneWithK0) {
  EXPECT_THAT(kinds_of("G0 Z9.\nG81 Z-5. R2. F60 K0\nX3.\nM30\n"),
              testing::ElementsAreArray(kinds_of("G0 Z9.\nG81 X3. Z-5. R2. F60\nM30\n")));
  EXPECT_EQ(fault_of("G81 X1. Z-5. R2. F60 K0"), "out_of_range");
}

TEST(FanucRigidTapping, TurnsTheSpindleItself) {
  Kept kept;
  const auto report = run_text(
      "G21 G0 X0 Y0 Z10.\nM29 S600\nG84 X0 Y0 Z-5. R2. F600.\nX9.\nG80\nX0\nM30\n", kFanuc, kept);
  ASSERT_TRUE(report && report->refused.empty()) << report->refused.front().text;
  std::vector<double> speeds;
  for (const Event& event : kept.events) {
    if (event.kind == EventKind::spindle) {
      speeds.push_back(event.value);
    }
  }
  EXPECT_THAT(speeds, ElementsAre(10.0, -10.0, 0.0, 10.0, -10.0, 0.0));
  for (const Move& move : kept.moves) {
    EXPECT_EQ(move.override_locked, move.kind != kRapid) << move.line;
  }
}

TEST(FanucRigidTapping, WorksForLeftHandThreadsAndFromATurningSpindle) {
  EXPECT_EQ(fault_of("M29 S500\nG74 X0 Y0 Z-5. R2. F500."), "");
  EXPECT_EQ(fault_of("M3 S500\nM29\nG84 X0 Y0 Z-5. R2. F500."), "");
}

TEST(FanucRigidTapping, EndsWithTheRowOfCycles) {
  const std::string tap = "M29 S500\nG84 X0 Y0 Z-5. R2. F500.\n";
  EXPECT_EQ(fault_of(tap + "G80\nG84 X0 Y0 Z-5. R2."), "spindle_direction");
  EXPECT_EQ(fault_of(tap + "G0 X1.\nG84 X0 Y0 Z-5. R2."), "spindle_direction");
  EXPECT_EQ(fault_of("M29\nG84 X0 Y0 Z-5. R2. F500."), "spindle_speed_missing");
}

TEST(FanucSpeedLimit, HoldsForEachG96UntilTheNext) {
  const auto moves = moves_of(
      "G21 G0 X9. Z5.\nG92 S1800\nG96 S150 M3\nG1 X20. F100\nG92 S600\nX30.\nG97 S1000\nX40.\n"
      "G96 S100\nX50.\nM30\n",
      kFanuc);
  ASSERT_EQ(moves.size(), 5U);
  EXPECT_EQ(moves[1].spindle_limit_rev_s, 30.0);
  EXPECT_EQ(moves[2].spindle_limit_rev_s, 10.0);
  EXPECT_EQ(moves[3].spindle_limit_rev_s, 0.0);
  EXPECT_NEAR(moves[3].spindle_rev_s, 1000.0 / 60.0, 1e-12);
  EXPECT_EQ(moves[4].spindle_limit_rev_s, 10.0);
}

TEST(FanucSpeedLimit, IsNeitherASpeedNorAnOrigin) {
  const auto moves =
      moves_of("G21 G0 X9.\nS500 M3\nG92 S2000\nG1 X10. F9\nG92 X0 S3000\nX1.\nM30\n", kFanuc);
  EXPECT_EQ(moves[1].end[0], 10.0);
  EXPECT_NEAR(moves[1].spindle_rev_s, 500.0 / 60.0, 1e-12);
  EXPECT_EQ(moves[2].offset[0], 10.0) << "with an axis word it is an origin as well";
  EXPECT_EQ(fault_of("G92 S0"), "out_of_range");
  EXPECT_EQ(fault_of("G92 S100\nG52 X1."), "");
  EXPECT_EQ(fault_of("G92"), "axis_words_missing");
}

}  // namespace
}  // namespace steadyrest::nc::interpret
