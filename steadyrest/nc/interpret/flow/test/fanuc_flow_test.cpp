// SPDX-License-Identifier: Apache-2.0
// Jumps, loops and macro calls of the dialect `fanuc`. Examples with results: FANUC Series 30i
// operator's manual B-63944EN, "Custom macro".
#include <string>
#include <utility>
#include <vector>

#include <gmock/gmock.h>

#include <steadyrest/nc/interpret/test/moves.hpp>

namespace steadyrest::nc::interpret {
namespace {

using testing::DoubleEq;
using testing::ElementsAre;
using testing::HasSubstr;

Config fanuc_flow(std::uint64_t most = 100'000) {
  Config config;
  config.dialect = read::Dialect::fanuc;
  config.most_repeated_lines = most;
  return config;
}

std::vector<double> x_of_flow(const std::string& text) {
  return ends_along(0, text, fanuc_flow());
}
std::string reason_of_flow(const std::string& text) {
  return reason_of(text, fanuc_flow());
}
read::Refused refused_flow(const std::string& text) {
  Kept kept;
  const auto report = run_text(text, fanuc_flow(), kept);
  return report && !report->refused.empty() ? report->refused.front() : read::Refused{};
}

// "Sample program: total of numbers 1 to 10", by IF and by WHILE: 55.
TEST(FanucFlow, AddsUpAsTheManualsExamplesDo) {
  EXPECT_THAT(x_of_flow("O9500\n#1=0\n#2=1\nN1 IF[#2 GT 10] GOTO 2\n#1=#1+#2\n#2=#2+1\nGOTO 1\n"
                        "N2 G0X#1\nM30\n"),
              ElementsAre(55.0));
  EXPECT_THAT(x_of_flow("O0001\n#1=0\n#2=1\nWHILE[#2 LE 10]DO 1\n#1=#1+#2\n#2=#2+1\nEND 1\nG0X#1\n"
                        "M30\n"),
              ElementsAre(55.0));
}

TEST(FanucFlow, JumpsForwardsBackwardsAndToCalculatedNumbers) {
  EXPECT_THAT(x_of_flow("GOTO10\nG0X1.\nN10G0X2.\nM30\n"), ElementsAre(2.0));
  EXPECT_THAT(x_of_flow("#1=20\nGOTO#1\nN10G0X1.\nN20G0X2.\nM30\n"), ElementsAre(2.0));
  EXPECT_THAT(x_of_flow("#1=2\nGOTO[#1*10]\nN10G0X1.\nN0020G0X2.\nM30\n"), ElementsAre(2.0));
  EXPECT_THAT(x_of_flow("#1=0\nN10#1=#1+1\nG0X#1\nif [#1 lt 3] goto 10\nM30\n"),
              ElementsAre(1.0, 2.0, 3.0));
  // Of another program in the same file a number does not count.
  EXPECT_THAT(x_of_flow("O1\nM98P2\nGOTO5\nG0X9.\nN5G0X1.\nM30\nO2\nGOTO5\nG0X8.\nN5G0X2.\nM99\n"),
              ElementsAre(2.0, 1.0));
}

TEST(FanucFlow, AssignsUnderACondition) {
  EXPECT_THAT(x_of_flow("#1=5\nIF[#1 EQ 5]THEN #2=7\nIF[#1 NE 5]THEN #2=8\nG0X#2\nM30\n"),
              ElementsAre(7.0));
  EXPECT_THAT(x_of_flow("#1=3\n#2=0\nIF[[#1 GT 1]AND[#1 LT 5]]THEN#2=1\nG0X#2\n"
                        "IF[[#1 LT 1]OR[#1 GT 5]]THEN#2=2\nG0X#2\nM30\n"),
              ElementsAre(1.0, 1.0));
}

// "Repetition": loops three deep, the same number again, a jump out.
TEST(FanucFlow, NestsLoopsThreeDeepAndJumpsOutOfThem) {
  EXPECT_THAT(x_of_flow("#1=0\nWHILE[#1 LT 2]DO1\n#1=#1+1\n#2=0\nWHILE[#2 LT 2]DO2\n#2=#2+1\n"
                        "#3=0\nWHILE[#3 LT 1]DO3\n#3=#3+1\nG0X[#1*10+#2]\nEND3\nEND2\nEND1\nM30\n"),
              ElementsAre(11.0, 12.0, 21.0, 22.0));
  EXPECT_THAT(x_of_flow("DO1\n#1=1\nGOTO9\nEND1\nN9DO1\nG0X1.\nGOTO10\nEND1\nN10G0X2.\nM30\n"),
              ElementsAre(1.0, 2.0));
}

TEST(FanucFlow, RefusesLoopsThatOverlapAndJumpsIntoThem) {
  EXPECT_EQ(reason_of_flow("DO1\nDO1\nEND1\nEND1\nM30\n"), "loop_number");
  EXPECT_EQ(reason_of_flow("DO1\nDO2\nEND1\nEND2\nM30\n"), "loop_number");
  EXPECT_EQ(reason_of_flow("DO4\nEND4\nM30\n"), "loop_number");
  EXPECT_EQ(reason_of_flow("DO1\nG0X1.\nM30\n"), "structure_open");
  EXPECT_EQ(reason_of_flow("G0X1.\nEND1\nM30\n"), "structure_unmatched");
  EXPECT_EQ(reason_of_flow("GOTO5\nDO1\nN5G0X1.\nEND1\nM30\n"), "jump_into_structure");
  EXPECT_EQ(reason_of_flow("GOTO5\nM30\n"), "no_jump_target");
  EXPECT_EQ(reason_of_flow("GOTO5\nN5\nN5\nM30\n"), "jump_target_twice");
  EXPECT_EQ(reason_of_flow("#1=1.5\nGOTO#1\nN1\nM30\n"), "no_jump_target");
  EXPECT_EQ(reason_of_flow("G0X1.GOTO5\nN5M30\n"), "flow_control");
  EXPECT_EQ(reason_of_flow("#1=1\nIF[#1]GOTO5\nN5M30\n"), "flow_control");
  EXPECT_EQ(reason_of_flow("#1=1\nIF[#1 EQ 1]G0X1.\nM30\n"), "flow_control");
  EXPECT_EQ(reason_of_flow("#1=0.1*3\nIF[#1 EQ 0.3]GOTO5\nN5M30\n"), "comparison_near");
}

TEST(FanucFlow, EndsProgramsThatDoNotEndAndNamesTheLoop) {
  const read::Refused jump = refused_flow("G0X1.\nN5G0X2.\nG0X3.\nGOTO5\nM30\n");
  EXPECT_EQ(jump.reason, "endless_program");
  EXPECT_EQ(jump.line, 4U);
  const read::Refused loop = refused_flow("DO1\nG0X1.\nEND1\nM30\n");
  EXPECT_EQ(loop.reason, "endless_program");
  EXPECT_EQ(loop.line, 3U);
}

// "Variables", undefined variable: <vacant> and 0 in a quotation, an operation, a condition.
TEST(FanucFlow, TellsVacantFromZeroAsTheManualsTableDoes) {
  const std::string head = "G0X9.\n#1=#0\n";
  EXPECT_THAT(x_of_flow(head + "G0X#1Y5.\nM30\n"), ElementsAre(9.0, 9.0));
  EXPECT_THAT(x_of_flow(head + "#2=#1\nG0X#2Y5.\nM30\n"), ElementsAre(9.0, 9.0));
  EXPECT_THAT(x_of_flow(head + "#2=#1*5\nG0X#2\nM30\n"), ElementsAre(9.0, 0.0));
  EXPECT_THAT(x_of_flow(head + "#2=#1+#1\nG0X#2\nM30\n"), ElementsAre(9.0, 0.0));
  const std::vector<std::pair<std::string, std::pair<bool, bool>>> table = {
      {"#1 EQ #0", {true, false}}, {"#1 NE 0", {true, false}}, {"#1 GE #0", {true, true}},
      {"#1 GT 0", {false, false}}, {"#1 LE 0", {true, true}},  {"#1 LT 0", {false, false}},
      {"#1 EQ 0", {false, true}},  {"#1 NE #0", {false, true}}};
  for (const auto& [condition, holds] : table) {
    const auto taken = [&](const std::string& value) {
      return x_of_flow("#1=" + value + "\n#2=0\nIF[" + condition + "]THEN#2=1\nG0X#2\nM30\n") ==
             std::vector{1.0};
    };
    EXPECT_EQ(taken("#0"), holds.first) << condition << " vacant";
    EXPECT_EQ(taken("0"), holds.second) << condition << " zero";
  }
  // What the program has not set may have been kept by the control.
  EXPECT_EQ(reason_of_flow("IF[#500 EQ #0]GOTO5\nN5M30\n"), "vacant_variable");
}

TEST(FanucFlow, GivesArgumentsByBothSpecifications) {
  const auto arguments = [](const std::string& given, const std::string& wanted) {
    return x_of_flow("G65P9010" + given + "\nM30\nO9010\nG0X" + wanted + "\nM99\n");
  };
  EXPECT_THAT(arguments("A1.B2.C3.", "[#1*100+#2*10+#3]"), ElementsAre(123.0));
  EXPECT_THAT(arguments("I4.J5.K6.", "[#4*100+#5*10+#6]"), ElementsAre(456.0));
  EXPECT_THAT(arguments("D7.E8.F9.H1.M3.", "[#7*1000+#8*100+#9*10+#11+#13]"), ElementsAre(7894.0));
  EXPECT_THAT(arguments("Q17.R18.S19.T20.U21.V22.W23.X24.Y25.Z26.",
                        "[#17+#18+#19+#20+#21+#22+#23+#24+#25+#26]"),
              ElementsAre(215.0));
  EXPECT_THAT(arguments("I1.J2.K3.I4.J5.K6.I7.", "[#4+#7*10+#10*100]"), ElementsAre(741.0));
  // The manual's mix of both: I4. and D5. are #7, the later counts.
  EXPECT_THAT(arguments("A1.B2.I-3.I4.D5.", "[#1*1000+#2*100+#4*10+#7]"), ElementsAre(1175.0));
  EXPECT_EQ(reason_of_flow("G65P1I1.I2.J3.\nM30\nO1\nM99\n"), "macro_argument");
  EXPECT_EQ(reason_of_flow("G65A1.\nM30\n"), "word_missing");
  EXPECT_EQ(reason_of_flow("G90G65P1\nM30\nO1\nM99\n"), "macro_call");
  // An argument that is left out is vacant.
  EXPECT_THAT(x_of_flow("G0X3.\nG65P9010A1.\nM30\nO9010\nIF[#2 EQ #0]THEN#2=8\nG0X#2Y#3\nM99\n"),
              ElementsAre(3.0, 8.0));
}

TEST(FanucFlow, HasLocalVariablesForEachLevelFourDeep) {
  // Each level sees its own #1; M98 its caller's.
  EXPECT_THAT(x_of_flow("#1=1\nG65P2A2.\nG0X#1\nM30\nO2\nG0X#1\n#1=5\nM98P3\nM99\nO3\nG0X#1\n"
                        "G65P4A7.\nG0X#1\nM99\nO4\nG0X#1\nM99\n"),
              ElementsAre(2.0, 5.0, 7.0, 5.0, 1.0));
  const std::string deep =
      "G65P2\nM30\nO2\nG65P3\nM99\nO3\nG65P4\nM99\nO4\nG65P5\nM99\nO5\nG0X1.\n";
  EXPECT_THAT(x_of_flow(deep + "M99\n"), ElementsAre(1.0));
  EXPECT_EQ(reason_of_flow(deep + "G65P6\nM99\nO6\nM99\n"), "calls_too_deep");
  EXPECT_THAT(x_of_flow("#100=0\nG65P2L3A4.\nM30\nO2\n#100=#100+#1\nG0X#100\nM99\n"),
              ElementsAre(4.0, 8.0, 12.0));
  EXPECT_EQ(reason_of_flow("G65P2L2A4.\nM30\nO2\n#1=#1+1\nM99\n"), "macro_repeat");
}

// "Modal call": after each block that moves; its variables are not set again.
TEST(FanucFlow, CallsAModalMacroAfterEachMove) {
  EXPECT_THAT(x_of_flow("G66P2A1.\nG0X10.\nG4P100\nX20.\nG67\nX30.\nM30\nO2\nG91G0X#1\nG90\n"
                        "#1=#1+1\nM99\n"),
              ElementsAre(10.0, 11.0, 11.0, 20.0, 22.0, 30.0));
  EXPECT_EQ(reason_of_flow("G66P2\nG66P3\nM30\nO2\nM99\nO3\nM99\n"), "macro_call");
  EXPECT_EQ(reason_of_flow("G66.1P2\nM30\nO2\nM99\n"), "macro_call");
}

TEST(FanucFlow, ReturnsToABlockOfTheCaller) {
  EXPECT_THAT(x_of_flow("M98P2\nG0X1.\nN10G0X2.\nM30\nO2\nM99P10\n"), ElementsAre(2.0));
  EXPECT_EQ(reason_of_flow("M98P2\nM30\nO2\nM99P10\n"), "no_jump_target");
  EXPECT_EQ(reason_of_flow("N10G0X1.\nM99P10\n"), "endless_program");
}

// For the verbs that rewrite: whether the jump is made or not.
TEST(FanucFlow, LinesThatAJumpMayRepeatAreNotAtTheTop) {
  auto source = read::LineSource::from_text(
      "G0X1.\nN5G0X2.\nG0X3.\nIF[#5021 GT 9.]GOTO5\nG0X4.\nGOTO9\nG0X5.\nN9M30\n");
  Kept kept;
  auto run = ProgramRun::make(source, fanuc_flow(), kept);
  ASSERT_TRUE(run.has_value());
  run->note_jumps();
  std::vector<std::uint32_t> top;
  while (run->step()) {
    if (run->at_top()) {
      top.push_back(run->line());
    }
  }
  EXPECT_THAT(top, ElementsAre(1U, 5U, 6U, 8U));
}

TEST(FanucFlow, ConvertsPackedDecimals) {
  EXPECT_THAT(x_of_flow("#1=BCD[29]\nG0X#1\n#2=BIN[#1]\nG0X#2\nM30\n"), ElementsAre(41.0, 29.0));
  EXPECT_EQ(reason_of_flow("#1=BIN[10]\nM30\n"), "out_of_domain");
}

// Series 30i: #5021 … show the machine, which the text does not know.
TEST(FanucFlow, SaysWhatAJumpThatTheControlDecidesDependsOn) {
  Kept kept;
  const auto report =
      run_text("G90G0X1.\nIF[#5021 GT 9.]GOTO5\nG0X2.\nN5G0X3.\nM30\n", fanuc_flow(), kept);
  ASSERT_TRUE(report && report->refused.empty());
  ASSERT_EQ(report->unknown.size(), 1U);
  EXPECT_EQ(report->unknown.front().name, "#5021");
  EXPECT_EQ(report->unknown.front().line, 2U);
  EXPECT_EQ(reason_of_flow("#1=#5021\nM98P#1\nM30\n"), "unknown_call");
}

}  // namespace
}  // namespace steadyrest::nc::interpret
