// SPDX-License-Identifier: Apache-2.0
// Jumps, loops and subprograms of the dialect `sinumerik`. Examples: SINUMERIK 840D sl, "Job
// planning" and "Fundamentals".
#include <filesystem>
#include <fstream>
#include <string>
#include <vector>

#include <gmock/gmock.h>
#include <unistd.h>

#include <steadyrest/nc/interpret/test/sinumerik.hpp>

namespace steadyrest::nc::interpret {
namespace {

using test::sinumerik;
using test::sinumerik_x_of;
using testing::ElementsAre;

Config bounded() {
  Config config = sinumerik();
  config.most_repeated_lines = 100'000;
  return config;
}
std::string reason_of_program(const std::string& text) {
  return reason_of(text, bounded());
}

TEST(SinumerikFlow, JumpsToLabelsAndBlockNumbers) {
  EXPECT_THAT(sinumerik_x_of("GOTOF LAST\nG0 X1\nLAST: G0 X2\nM30\n"), ElementsAre(2.0));
  EXPECT_THAT(sinumerik_x_of("gotof N100\nG0 X1\nN100 G0 X2\nM30\n"), ElementsAre(2.0));
  EXPECT_THAT(sinumerik_x_of("GOTO LAST\nG0 X1\nN20 last:\nG0 X2\nM30\n"), ElementsAre(2.0));
  EXPECT_THAT(sinumerik_x_of("R1=0\nAGAIN: R1=R1+1\nG0 X=R1\nIF R1<3 GOTOB AGAIN\nM30\n"),
              ElementsAre(1.0, 2.0, 3.0));
  EXPECT_THAT(sinumerik_x_of("DEF STRING[20] WHERE=\"LB\"\nR1=2\nGOTOF \"LB\"<<R1\nLB1: G0 X1\n"
                             "LB2: G0 X2\nGOTOF WHERE\nG0 X3\nLB: G0 X4\nM30\n"),
              ElementsAre(2.0, 4.0));
  EXPECT_THAT(sinumerik_x_of("GOTOC NOWHERE\nG0 X1\nM30\n"), ElementsAre(1.0));
}

// Several conditional jumps in one block: "the first that is fulfilled".
TEST(SinumerikFlow, TakesTheFirstJumpWhoseConditionHolds) {
  for (const auto& [value, x] : {std::pair{1, 10.0}, std::pair{2, 20.0}, std::pair{3, 30.0}}) {
    const std::string text = "R1=" + std::to_string(value) +
                             "\nIF R1==1 GOTOF MA1 IF R1==2 GOTOF MA2\nG0 X30\nM30\n"
                             "MA1: G0 X10\nM30\nMA2: G0 X20\nM30\n";
    EXPECT_THAT(sinumerik_x_of(text), ElementsAre(x));
    const std::string branch = "R1=" + std::to_string(value) +
                               "\nCASE R1 OF 1 GOTOF MA1 2 GOTOF MA2 DEFAULT GOTOF MA3\n"
                               "MA1: G0 X10\nM30\nMA2: G0 X20\nM30\nMA3: G0 X30\nM30\n";
    EXPECT_THAT(sinumerik_x_of(branch), ElementsAre(x));
  }
}

TEST(SinumerikFlow, HasConditionsAndLoops) {
  EXPECT_THAT(sinumerik_x_of("R1=1\nIF R1==1\nG0 X1\nELSE\nG0 X2\nENDIF\nIF R1==2\nG0 X3\nELSE\n"
                             "G0 X4\nENDIF\nIF R1<>1\nG0 X5\nENDIF\nM30\n"),
              ElementsAre(1.0, 4.0));
  EXPECT_THAT(sinumerik_x_of("DEF INT II\nFOR II=1 TO 3\nG0 X=II\nENDFOR\nG0 X=II*10\nM30\n"),
              ElementsAre(1.0, 2.0, 3.0, 40.0));
  EXPECT_THAT(sinumerik_x_of("FOR R2=3 TO 2\nG0 X=R2\nENDFOR\nG0 X9\nM30\n"), ElementsAre(9.0));
  EXPECT_THAT(sinumerik_x_of("R1=3\nWHILE R1>1\nG0 X=R1\nR1=R1-1\nENDWHILE\nM30\n"),
              ElementsAre(3.0, 2.0));
  EXPECT_THAT(sinumerik_x_of("R1=5\nREPEAT\nG0 X=R1\nR1=R1+1\nUNTIL R1>5\nM30\n"),
              ElementsAre(5.0));
  EXPECT_THAT(
      sinumerik_x_of("R1=0\nLOOP\nR1=R1+1\nIF R1==3 GOTOF OUT\nG0 X=R1\nENDLOOP\nOUT: M30\n"),
      ElementsAre(1.0, 2.0));
}

// "Repeating program sections": the section is executed P times more.
TEST(SinumerikFlow, RepeatsSections) {
  EXPECT_THAT(sinumerik_x_of("G91\nPOS1: G0 X1\nREPEATB POS1 P=2\nM30\n"),
              ElementsAre(1.0, 2.0, 3.0));
  EXPECT_THAT(sinumerik_x_of("R1=10\nSTART: G90 G0 X=R1\nR1=R1+1\nREPEAT START P=2\nG0 X1\nM30\n"),
              ElementsAre(10.0, 11.0, 12.0, 1.0));
  EXPECT_THAT(sinumerik_x_of("BEG: G0 X1\nFIN: G0 X2\nG0 X3\nREPEAT BEG FIN\nG0 X4\nM30\n"),
              ElementsAre(1.0, 2.0, 3.0, 1.0, 2.0, 4.0));
  EXPECT_THAT(sinumerik_x_of("BEG: G0 X1\nENDLABEL: G0 X2\nREPEAT BEG ENDLABEL P=2\nM30\n"),
              ElementsAre(1.0, 2.0, 1.0, 2.0, 1.0, 2.0));
  EXPECT_EQ(reason_of_program("BEG: G0 X1\nGOTOF OUT\nREPEAT BEG P=2\nOUT: M30\n"), "");
  EXPECT_EQ(reason_of_program("R1=0\nBEG: R1=R1+1\nIF R1>1 GOTOF OUT\nREPEAT BEG P=2\nOUT: M30\n"),
            "jump_out_of_section");
  EXPECT_EQ(reason_of_program("REPEAT NONE P=2\nM30\n"), "no_jump_target");
}

TEST(SinumerikFlow, RefusesWhatDoesNotBelongTogether) {
  EXPECT_EQ(reason_of_program("IF 1==1\nG0 X1\nM30\n"), "structure_open");
  EXPECT_EQ(reason_of_program("FOR R1=1 TO 2\nENDWHILE\nM30\n"), "structure_unmatched");
  EXPECT_EQ(reason_of_program("LOOP\nENDIF\nM30\n"), "structure_unmatched");
  EXPECT_EQ(reason_of_program("ELSE\nM30\n"), "structure_unmatched");
  EXPECT_EQ(reason_of_program("GOTOF INSIDE\nLOOP\nINSIDE: G0 X1\nENDLOOP\nM30\n"),
            "jump_into_structure");
  EXPECT_EQ(reason_of_program("GOTOB AHEAD\nAHEAD: M30\n"), "no_jump_target");
  EXPECT_EQ(reason_of_program("G0 X1 GOTOF AA\nAA: M30\n"), "flow_control");
  EXPECT_EQ(reason_of_program("IF R1 GOTOF AA\nAA: M30\n"), "unset_parameter");
  EXPECT_EQ(reason_of_program("LOOP\nG0 X1\nENDLOOP\nM30\n"), "endless_program");
  EXPECT_EQ(reason_of_program("GOTOS\nM30\n"), "endless_program");
  EXPECT_EQ(reason_of_program("R2=3\nFOR R1=1 TO R2\nR2=2\nENDFOR\nM30\n"), "loop_end_changed");
}

TEST(SinumerikFlow, HasArraysAndStrings) {
  EXPECT_THAT(
      sinumerik_x_of("DEF REAL AA[3]=SET(1,2,3)\nDEF INT II\nFOR II=0 TO 2\nAA[II]=AA[II]*2\n"
                     "G0 X=AA[II]\nENDFOR\nM30\n"),
      ElementsAre(2.0, 4.0, 6.0));
  EXPECT_THAT(
      sinumerik_x_of("DEF REAL TT[2,2]=(1,2,3)\nG0 X=TT[0,1]\nG0 X=TT[1,0]\nG0 X=TT[1,1]\nM30\n"),
      ElementsAre(2.0, 3.0, 0.0));
  EXPECT_THAT(sinumerik_x_of("DEF BOOL BB[4]=REP(1)\nIF BB[3]\nG0 X1\nENDIF\nM30\n"),
              ElementsAre(1.0));
  EXPECT_THAT(
      sinumerik_x_of("DEF STRING[16] NAME=\"TOP\"\nIF NAME==\"TOP\"\nG0 X1\nENDIF\n"
                     "NAME=\"BOT\"<<7\nIF NAME==\"BOT7\" GOTOF OK\nG0 X2\nOK: G0 X3\n"
                     "MSG(\"AT \"<<NAME<<\" \"<<1+2)\nMSG(NAME)\nSETAL(65001,\"X\")\nM30\n"),
      ElementsAre(1.0, 3.0));
  EXPECT_THAT(sinumerik_x_of("DEF CHAR CC=\"A\"\nG0 X=CC\nM30\n"), ElementsAre(65.0));
  EXPECT_EQ(reason_of_program("DEF REAL AA[3]\nX=AA[3]\nM30\n"), "variable");
  EXPECT_EQ(reason_of_program("DEF REAL AA[3]=SET(1,2,3,4)\nM30\n"), "array");
  EXPECT_EQ(reason_of_program("DEF REAL AA[99999999]\nM30\n"), "array");
  EXPECT_EQ(reason_of_program("DEF AXIS AA\nM30\n"), "definition");
  EXPECT_EQ(reason_of_program("SETAL(66000)\nM30\n"), "alarm");
}

TEST(SinumerikFlow, CallsProgramsOfTheSameFileAndByName) {
  const std::string sub =
      "%_N_SHELL_SPF\nPROC SHELL(REAL WIDTH, INT N=2) SBLOF DISPLOF\nG0 X=WIDTH*N\nM17\n";
  EXPECT_THAT(sinumerik_x_of("%_N_MAIN_MPF\nEXTERN SHELL(REAL,INT)\nSHELL(3)\nSHELL(3,4)\n"
                             "CALL \"SHELL\"\nM30\n" +
                             sub),
              ElementsAre(6.0, 12.0, 0.0));
  EXPECT_THAT(sinumerik_x_of("%_N_MAIN_MPF\nDEF STRING[12] WHICH=\"SHELL\"\nCALL WHICH\n"
                             "PCALL /_N_WKS_DIR/_N_P_WPD/SHELL(1)\nM30\n" +
                             sub),
              ElementsAre(0.0, 2.0));
  EXPECT_EQ(reason_of_program("%_N_MAIN_MPF\nG0 X1\n%_N_SUB_SPF\nM17\n"), "no_program_end");
  EXPECT_EQ(reason_of_program("%_N_MAIN_MPF\nSUB\nM30\n%_N_SUB_SPF\nSUB\nM17\n"), "calls_too_deep");
  // A label belongs to its program.
  EXPECT_EQ(reason_of_program("%_N_MAIN_MPF\nGOTOF THERE\nM30\n%_N_SUB_SPF\nTHERE: M17\n"),
            "no_jump_target");
}

// "Subprograms with parameter transfer": call by reference.
TEST(SinumerikFlow, GivesAParameterBackToItsVariable) {
  const std::string sub = "%_N_ADD_SPF\nPROC ADD(VAR REAL SUM, REAL BY)\nSUM=SUM+BY\nM17\n";
  EXPECT_THAT(sinumerik_x_of("%_N_MAIN_MPF\nDEF REAL TOTAL=1\nADD(TOTAL,2)\nG0 X=TOTAL\n"
                             "ADD(TOTAL,10) P3\nG0 X=TOTAL\nM30\n" +
                             sub),
              ElementsAre(3.0, 33.0));
  EXPECT_EQ(reason_of_program("%_N_MAIN_MPF\nADD(1,2)\nM30\n" + sub), "definition");
  EXPECT_EQ(reason_of_program("%_N_MAIN_MPF\nDEF INT NN\nADD(NN,2)\nM30\n" + sub), "definition");
}

// MCALL: after each block with a movement, until MCALL alone.
TEST(SinumerikFlow, CallsAModalSubprogramAfterEachMove) {
  EXPECT_THAT(sinumerik_x_of("%_N_MAIN_MPF\nMCALL DOT(5)\nG0 X10\nG4 F1\nX20\nMCALL\nX30\nM30\n"
                             "%_N_DOT_SPF\nPROC DOT(REAL S)\nG91 G0 X=S\nG90\nRET\n"),
              ElementsAre(10.0, 15.0, 15.0, 20.0, 25.0, 30.0));
}

TEST(SinumerikFlow, KnowsSystemVariablesThatFollowFromTheText) {
  Kept kept;
  auto report =
      run_text("G17 G90 G71 G0 X7 Y1\nR1=$P_EP[X]\nG0 X=R1+1\nR2=$P_GG[14]\nG0 Y=R2\nM30\n",
               sinumerik(), kept);
  ASSERT_TRUE(report && report->refused.empty());
  EXPECT_EQ(kept.moves.at(1).end[0], 8.0);
  EXPECT_EQ(kept.moves.at(2).end[1], 1.0);
  EXPECT_TRUE(report->unknown.empty());
  report = run_text("IF $P_SEARCH GOTOF OUT\nR1=$AA_IW[X]\nG0 X1\nOUT: M30\n", sinumerik(), kept);
  ASSERT_TRUE(report && report->refused.empty());
  ASSERT_EQ(report->unknown.size(), 2U);
  EXPECT_EQ(report->unknown[0].name, "$P_SEARCH");
  EXPECT_EQ(report->unknown[1].name, "$AA_IW[X]");
  EXPECT_EQ(report->unknown[1].line, 2U);
}

// Where a wait loop's condition is the control's, it is left at once or never: refused, by its
// line.
TEST(SinumerikFlow, RefusesAWaitForTheControlThatDoesNotEnd) {
  Kept kept;
  const auto report =
      run_text("G0 X1\nWHILE $A_IN[1]==0\nSTOPRE\nENDWHILE\nM30\n", bounded(), kept);
  ASSERT_TRUE(report && !report->refused.empty());
  EXPECT_EQ(report->refused.front().reason, "endless_program");
  EXPECT_EQ(report->refused.front().line, 4U);
}

}  // namespace
}  // namespace steadyrest::nc::interpret
