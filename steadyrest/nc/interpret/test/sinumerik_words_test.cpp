// SPDX-License-Identifier: Apache-2.0
// Words of the dialect `sinumerik` that set modes, and those that move nothing.
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

std::vector<Assumption> assumed_in(const std::string& text) {
  Kept kept;
  const auto report = run_text("G71 G94\n" + text + "\nM30\n", sinumerik(), kept);
  EXPECT_TRUE(report.has_value() && report->refused.empty()) << text;
  std::vector<Assumption> out;
  for (const Assumption& one : report->assumed) {
    if (one.what == "dynamics") {
      out.push_back(one);
    }
  }
  return out;
}

// "Fundamentals" and "Job planning": the moves around these words are those without them.
TEST(SinumerikWords, ThatMoveNothingLeaveTheMovesAlone) {
  const char* const words[] = {"SOFT",
                               "SOFTA(X,Y)",
                               "BRISK",
                               "BRISKA",
                               "DRIVE",
                               "FFWON",
                               "FFWOF",
                               "DYNNORM",
                               "DYNFINISH",
                               "DYNROUGH",
                               "FLIN",
                               "FCUB",
                               "CFTCP",
                               "FGROUP(X,Y,Z)",
                               "FGROUP()",
                               "FGREF[A]=10",
                               "ACC[X]=50",
                               "VELOLIM[X]=90 JERKLIM[Y]=R1",
                               "UPATH",
                               "STARTFIFO",
                               "STOPFIFO",
                               "STOPRE",
                               "SPCON",
                               "SPCOF(1)",
                               "WALIMON",
                               "WALIMOF",
                               "G25 X-10 Y-10 Z-5",
                               "G26 X100 Y100",
                               "ORIWKS",
                               "ORIMKS",
                               "ORIAXES",
                               "CUT2DF",
                               "NORM",
                               "G450",
                               "CDOF2",
                               "G290",
                               "G62",
                               "G602",
                               "SETAL(65000)",
                               "SETAL(65001,\"look; at (this\")",
                               "MSG(\"x\")",
                               "WORKPIECE(,\"\",,\"BOX\",112,0,-20,-80,0,0,100,100)",
                               "GROUP_BEGIN(0,\"pocket\",0,0)",
                               "GROUP_END(0,0)",
                               "$TC_DP3[1,1]=120",
                               "$TC_TP2[1]=\"MILL\"",
                               "S2=500 M2=3",
                               "M2=5",
                               "M40",
                               "OTOL=0.5",
                               "ATOL[X]=0.1",
                               ";#6__DlgK contour",
                               "DIAMOF"};
  for (const std::string word : words) {
    EXPECT_THAT(sinumerik_x_of("R1=3\nG0 X1\n" + word + "\nX2\nM30\n"), ElementsAre(1, 2)) << word;
  }
}

// What changes only the course in time is said, since the plan has the machine file's values.
TEST(SinumerikWords, ThatChangeTheDynamicsAreReported) {
  for (const std::string word : {"BRISK", "ACC[X]=50", "DYNROUGH", "FFWON", "FGROUP(X,Y)", "FLIN",
                                 "CYCLE832(0.01,1,1)", "G621"}) {
    const auto assumed = assumed_in("G0 X1\n" + word + "\nBRISK");
    ASSERT_EQ(assumed.size(), 1U) << word;
    EXPECT_EQ(assumed[0].line, 3U) << word;
    EXPECT_FALSE(assumed[0].bars_rewriting) << word;
  }
  EXPECT_TRUE(assumed_in("SOFT FFWOF DYNNORM FNORM").empty());
}

TEST(SinumerikWords, AreRefusedWithAValueOrABracketTooMuchOrTooLittle) {
  EXPECT_EQ(reason_of_block("SOFT=1"), "bad_value");
  EXPECT_EQ(reason_of_block("FGROUP(X,Y"), "unclosed_expression");
  EXPECT_EQ(reason_of_block("ACC[X=5"), "unclosed_expression");
  EXPECT_EQ(reason_of_block("SETAL(1 ; )"), "unclosed_expression");
  EXPECT_EQ(reason_of_block("CTOL"), "missing_value");
  EXPECT_EQ(reason_of_block("TRANS X1 CTOL=0.1"), "frame");
  EXPECT_EQ(reason_of_block("SPOS"), "missing_value");
  EXPECT_EQ(reason_of_block("SPOS=DC(90"), "unclosed_expression");
}

// "Fundamentals", SPOS and M19: the spindle stands at an angle.
TEST(SinumerikSpindle, StandsAfterItsPosition) {
  for (const char* word : {"SPOS=90", "SPOSA=DC(R1*2)", "SPOS[1]=ACP(5)", "M19", "M1=19"}) {
    const auto moves = moves_of(
        "R1=45\nS600 M3\nG1 X1 F100\n" + std::string{word} + "\nX2\nM3\nX3\nM30\n", sinumerik());
    ASSERT_EQ(moves.size(), 3U);
    EXPECT_DOUBLE_EQ(moves[0].spindle_rev_s, 10.0) << word;
    EXPECT_DOUBLE_EQ(moves[1].spindle_rev_s, 0.0) << word;
    EXPECT_DOUBLE_EQ(moves[2].spindle_rev_s, 10.0) << word;
  }
  // Another spindle stands: the master turns on.
  const auto moves = moves_of("S600 M3\nSPOS[2]=0\nM2=19\nG1 X2 F100\nM30\n", sinumerik());
  EXPECT_DOUBLE_EQ(moves.at(0).spindle_rev_s, 10.0);
}

// LIMS and G26 S bound the speed; in G96 the plan has to know it.
TEST(SinumerikSpindle, KeepsItsLimit) {
  const auto moves = moves_of("LIMS=3000\nG96 S200 M3\nG1 X10 F0.2\nM30\n", sinumerik());
  EXPECT_DOUBLE_EQ(moves.at(0).spindle_limit_rev_s, 50.0);
  EXPECT_DOUBLE_EQ(
      moves_of("G96 S200 M3 LIMS=600\nG1 X10 F0.2\nM30\n", sinumerik()).at(0).spindle_limit_rev_s,
      10.0);
  EXPECT_EQ(reason_of_block("G26 S1000\nS1001"), "speed_above_limit");
  EXPECT_EQ(reason_of_block("S1001\nLIMS=1000"), "speed_above_limit");
  EXPECT_EQ(reason_of_block("G26 S1000\nS1000"), "");
  EXPECT_EQ(reason_of_block("G25 S50"), "g_code_not_interpreted");
}

// "Fundamentals", DIAMON: X is a diameter.
TEST(SinumerikWords, TakeDiameters) {
  EXPECT_THAT(sinumerik_x_of("DIAMON\nG0 X20\nDIAMOF\nX20\nM30\n"), ElementsAre(10, 20));
  EXPECT_EQ(reason_of_block("DIAM90"), "unknown_word");
}

// "Fundamentals", G331 and G332: the sign of the pitch is the hand of the thread.
TEST(SinumerikTapping, GoesInAndOutWithTheSpindle) {
  const auto moves =
      moves_of("G0 Z5\nSPOS=0\nG331 Z-10 K0.8 S300\nG332 Z5 K0.8\nG1 X1 F50\nM30\n", sinumerik());
  ASSERT_EQ(moves.size(), 4U);
  EXPECT_EQ(moves[1].kind, MoveKind::thread);
  EXPECT_EQ(moves[1].feed_mode, FeedMode::per_revolution);
  EXPECT_DOUBLE_EQ(moves[1].feed_mm_s, 0.8);
  EXPECT_DOUBLE_EQ(moves[1].spindle_rev_s, 5.0);
  EXPECT_DOUBLE_EQ(moves[2].spindle_rev_s, -5.0);
  EXPECT_EQ(moves[2].end[2], 5.0);
  EXPECT_EQ(moves[3].spindle_rev_s, 0.0);
  const auto left = moves_of("G0 Z5\nG331 Z-10 K-0.8 S300\nM30\n", sinumerik());
  EXPECT_DOUBLE_EQ(left.at(1).spindle_rev_s, -5.0);
  EXPECT_EQ(reason_of_block("G331 Z-10 K0.8"), "speed_missing");
  EXPECT_EQ(reason_of_block("S50 G331 Z-10"), "pitch_missing");
  EXPECT_EQ(reason_of_block("S50 G331 Z-10 I1"), "pitch_missing");
  EXPECT_EQ(reason_of_block("S50 G331 X1 K1"), "axis_in_cycle");
}

TEST(SinumerikTapping, FollowsTheSpindleByG33AndAFeedByG63) {
  const auto thread = moves_of("S300 M3\nG0 Z5\nG33 Z-10 K1.5\nM30\n", sinumerik());
  EXPECT_EQ(thread.at(1).kind, MoveKind::thread);
  EXPECT_DOUBLE_EQ(thread.at(1).feed_mm_s, 1.5);
  const auto moves = moves_of("S300 M3 G0 Z5\nG1 X1 F240\nG63 Z-10\nX2\nM30\n", sinumerik());
  ASSERT_EQ(moves.size(), 4U);
  EXPECT_TRUE(moves[2].override_locked);
  EXPECT_DOUBLE_EQ(moves[2].feed_mm_s, 4.0);
  EXPECT_FALSE(moves[3].override_locked);
  EXPECT_EQ(moves[3].kind, MoveKind::linear);
}

// "Job planning", CTOL; the compressors make one of the lines within it.
TEST(SinumerikSmoothing, TakesToleranceAndModeIntoThePath) {
  const auto of = [](const std::string& words) {
    const auto moves = moves_of("G71\n" + words + "\nG1 X1 F100\nM30\n", sinumerik());
    return std::pair{moves.at(0).path_tolerance_mm, moves.at(0).merge_tolerance_mm};
  };
  EXPECT_EQ(of("G64 ADIS=0.5"), std::pair(0.5, -1.0));
  EXPECT_EQ(of("G642 ADIS=0.5"), std::pair(0.5, -1.0));
  EXPECT_EQ(of("G642 ADIS=0.5 CTOL=0.02"), std::pair(0.02, -1.0));
  EXPECT_EQ(of("G645 CTOL=0.02"), std::pair(0.02, -1.0));
  EXPECT_EQ(of("G641 ADIS=0.5 CTOL=0.02"), std::pair(0.5, -1.0));
  EXPECT_EQ(of("G642 CTOL=0.02 COMPCAD"), std::pair(0.02, 0.02));
  EXPECT_EQ(of("G642 CTOL=0.02 COMPCURV\nCOMPOF"), std::pair(0.02, -1.0));
  EXPECT_EQ(of("G642 CTOL=0.02 COMPON\nCTOL=-1"), std::pair(0.0, -1.0));
  EXPECT_EQ(of("G642 CTOL=0.02\nG60").first, 0.0);
  EXPECT_EQ(of("G700 CTOL=0.01 G642").first, 0.254);
}

// "Cycles", CYCLE832: by number, by name, by the digits of older versions.
TEST(SinumerikSmoothing, IsSetByCycle832) {
  const auto of = [](const std::string& call) {
    const auto moves = moves_of("G71 G60\n" + call + "\nG1 X1 F100\nM30\n", sinumerik());
    const Move& move = moves.at(0);
    return std::tuple{move.path_mode, move.path_tolerance_mm, move.merge_tolerance_mm};
  };
  for (const char* call :
       {"CYCLE832(0.02,1,1)", "CYCLE832(0.02,3)", "CYCLE832(0.02,_FINISH,1)",
        "CYCLE832(0.02,_ROUGH)", "CYCLE832(0.02,_ORI_SEMIFIN,0.5)", "CYCLE832(0.02,4)",
        "CYCLE832(0.02,_TOP_SURFACE_SMOOTH_ON+_ORI_FINISH,1)", "CYCLE832(0.02,112103)",
        "R1=0.02\nCYCLE832(R1,1003)"}) {
    EXPECT_EQ(of(call), std::tuple(PathMode::continuous, 0.02, 0.02)) << call;
  }
  for (const char* call : {"CYCLE832()", "CYCLE832(0,0)", "CYCLE832(0.02,_OFF,1)",
                           "CYCLE832(0.02,1)\nCYCLE832(0,0,1)", "CYCLE832"}) {
    EXPECT_EQ(of(call), std::tuple(PathMode::continuous, 0.0, -1.0)) << call;
  }
  EXPECT_EQ(reason_of_block("CYCLE832(0.02)"), "cycle_word_missing");
  EXPECT_EQ(reason_of_block("CYCLE832(0.02,5)"), "cycle_value");
  EXPECT_EQ(reason_of_block("CYCLE832(-0.02,1)"), "cycle_value");
  EXPECT_EQ(reason_of_block("CYCLE832(0.02,11)"), "transformation");
  EXPECT_EQ(reason_of_block("CYCLE832(0.02,21,1)"), "cycle_value");
  EXPECT_EQ(reason_of_block("MCALL CYCLE832(0.02,1)"), "modal_call");
}

}  // namespace
}  // namespace steadyrest::nc::interpret
