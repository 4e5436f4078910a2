// SPDX-License-Identifier: Apache-2.0
// Custom macros and subprograms of the dialect `fanuc`.
#include <filesystem>
#include <fstream>
#include <string>

#include <gmock/gmock.h>
#include <unistd.h>

#include <steadyrest/nc/interpret/test/moves.hpp>

namespace steadyrest::nc::interpret {
namespace {

using testing::ElementsAre;

Config fanuc() {
  Config config;
  config.dialect = read::Dialect::fanuc;
  return config;
}

std::vector<double> fanuc_x_of(const std::string& text, const Config& config = fanuc()) {
  return ends_along(0, text, config);
}

/// The value of `#1=…`, to three decimals.
double macro_value_of(const std::string& expression) {
  return fanuc_x_of("#1=" + expression + "\nG0X#1\nM30\n").at(0);
}

// FANUC Series 16/18 operator's manual, "Arithmetic and logic operation": * / AND before + - OR
// XOR.
TEST(Macro, HasThePrecedenceOfTheManual) {
  EXPECT_EQ(macro_value_of("1+2*3"), 7.0);
  EXPECT_EQ(macro_value_of("8-2-1"), 5.0);
  EXPECT_EQ(macro_value_of("4OR1AND3"), 5.0);  // 4 OR [1 AND 3]
  EXPECT_EQ(macro_value_of("4+1OR2"), 7.0);    // [4+1] OR 2
  EXPECT_EQ(macro_value_of("6AND3*2"), 4.0);   // [6 AND 3]*2
  EXPECT_EQ(macro_value_of("7XOR2"), 5.0);
  EXPECT_EQ(macro_value_of("-[2+3]*2"), -10.0);
  EXPECT_EQ(macro_value_of("17MOD5*2"), 4.0);
}

// The manual's rule: FIX discards, FUP adds one to the magnitude, ROUND goes to the nearest.
TEST(Macro, RoundsAwayFromAndTowardsZeroByMagnitude) {
  EXPECT_EQ(macro_value_of("FIX[-1.2]"), -1.0);
  EXPECT_EQ(macro_value_of("FUP[-1.2]"), -2.0);
  EXPECT_EQ(macro_value_of("FIX[1.2]"), 1.0);
  EXPECT_EQ(macro_value_of("FUP[1.2]"), 2.0);
  EXPECT_EQ(macro_value_of("ROUND[2.5]"), 3.0);
  EXPECT_EQ(macro_value_of("RO[2.4]"), 2.0);
}

TEST(Macro, HasItsOwnRangesOfArcFunctions) {
  EXPECT_EQ(macro_value_of("ATAN[1]/[-1]"), 135.0);
  EXPECT_EQ(macro_value_of("ATAN[-1]/[-1]"), 225.0);
  EXPECT_EQ(macro_value_of("ATAN[-1,-1]"), 225.0);
  EXPECT_EQ(macro_value_of("ATAN[-1]"), -45.0);
  EXPECT_EQ(macro_value_of("ASIN[-1]"), 270.0);
  EXPECT_EQ(macro_value_of("ACOS[-1]"), 180.0);
  EXPECT_EQ(macro_value_of("ATAN[1]/5"), 9.0);
}

// Haas mill operator's manual 96-8000, "ROUND": in an address it rounds to the address's precision.
TEST(Macro, RoundsAddressesToTheirIncrementAsTheHaasManualPrints) {
  // 1.00333 + 1.00333 = 2.00666 is rounded once; rounded separately it is 1.0033 + 1.0033.
  EXPECT_DOUBLE_EQ(fanuc_x_of("G20\n#1=1.00333\nG0X[#1+#1]\nM30\n").at(0), 2.0067 * 25.4);
  EXPECT_DOUBLE_EQ(fanuc_x_of("G20\n#1=1.00333\nG0X[ROUND[#1]+ROUND[#1]]\nM30\n").at(0),
                   2.0066 * 25.4);
  EXPECT_DOUBLE_EQ(moves_of("#1=1.00333\nG0A[#1+#1]\nM30\n", fanuc()).at(0).end[3], 2.007);
  EXPECT_DOUBLE_EQ(moves_of("#1=1.00333\nG0A[ROUND[#1]+ROUND[#1]]\nM30\n", fanuc()).at(0).end[3],
                   2.006);
}

// Series 30i operator's manual, "Variables": 12.3456 in #1, 1/1000 mm: G00X#1 is G00X12.346.
TEST(Macro, RoundsAVariableToTheLeastIncrementAsTheManualPrints) {
  EXPECT_DOUBLE_EQ(fanuc_x_of("#1=12.3456\nG00X#1\nM30\n").at(0), 12.346);
  EXPECT_DOUBLE_EQ(fanuc_x_of("#1=12.3456\nG00X-#1\nM30\n").at(0), -12.346);
}

TEST(Macro, ReadsAVariableInUnitsWhateverTheDecimalRuleIs) {
  Config config = fanuc();
  config.decimal_rule = DecimalRule::least_increment;
  EXPECT_EQ(fanuc_x_of("#1=100\nG0X#1\nM30\n", config).at(0), 100.0);
}

TEST(Macro, RefusesWhatWasNeverSetAndWhatTheControlAloneKnows) {
  EXPECT_EQ(reason_of("G0X#1\nM30\n", fanuc()), "vacant_variable");
  EXPECT_EQ(reason_of("#1=2\n#1=#0\n#2=-#1\nM30\n", fanuc()), "vacant_variable");
  EXPECT_EQ(reason_of("#2=#500\nM30\n", fanuc()), "vacant_variable");
  EXPECT_EQ(reason_of("#2=#3001\nM30\n", fanuc()), "system_variable");
  EXPECT_EQ(reason_of("#40=1\nM30\n", fanuc()), "no_such_parameter");
  EXPECT_EQ(reason_of("#5221=1\nM30\n", fanuc()), "read_only_parameter");
}

TEST(Macro, AnswersForPositionsAndModes) {
  Config config = fanuc();
  config.work_offset[0][0] = 50.0;
  Tool tool;
  tool.number = 3;
  tool.offset[2] = 7.0;
  config.tools = std::vector{tool};
  const std::string head = "G54G90G0G43H3X5.Y6.Z8.\n";
  const auto after = [&](const std::string& variable) {
    return fanuc_x_of(head + "#1=" + variable + "\nX#1\nM30\n", config).at(1);
  };
  // Work position; machine position with offset and tool; the nose, the tool's 7 mm above the tip.
  EXPECT_EQ(after("#5001"), 5.0);
  EXPECT_EQ(after("#5003"), 8.0);
  EXPECT_EQ(after("#5021"), 55.0);
  EXPECT_EQ(after("#5023"), 15.0);
  EXPECT_EQ(after("#5043"), 15.0);
  EXPECT_EQ(after("#4001"), 0.0);
  EXPECT_EQ(after("#4003"), 90.0);
  EXPECT_EQ(after("#4014"), 54.0);
}

// Structure of the manual's "Subprogram (M98, M99)": O numbers in one file, calls in a chain.
TEST(Macro, CallsProgramsOfTheSameFileByTheirNumber) {
  EXPECT_THAT(fanuc_x_of("%\nO1\nG91G0X1.\nM98P8001\nX100.\nM30\nO8002\nX1000.\nM99\nO8001\nX10.\n"
                         "M98P8002\nM99\n%\n"),
              ElementsAre(1, 11, 1011, 1111));
}

// Robur F1 series, concise guide FANUC, page 86: "subprogram 8003 six times: M98 P68003".
TEST(Macro, RepeatsByLAndByTheDigitsOfP) {
  EXPECT_THAT(fanuc_x_of("G91\nM98 P68003\nM30\nO8003\nG0X1.\nM99\n"),
              ElementsAre(1, 2, 3, 4, 5, 6));
  EXPECT_THAT(fanuc_x_of("G91\nM98P2L3\nM30\n:2\nG0X1.\nM99\n"), ElementsAre(1, 2, 3));
  EXPECT_THAT(fanuc_x_of("G91\nM98P30002\nM30\nO2\nG0X1.\nM99\n"), ElementsAre(1, 2, 3));
}

TEST(Macro, SharesLocalVariablesWithASubprogram) {
  EXPECT_THAT(fanuc_x_of("#1=3\nM98P2\nG0X#1\nM30\nO2\n#1=#1+4\nM99\n"), ElementsAre(7));
}

TEST(Macro, FindsASubprogramInAFileOfItsOwn) {
  namespace fs = std::filesystem;
  const fs::path folder = fs::temp_directory_path() / ("nc-macro-" + std::to_string(::getpid()));
  fs::create_directory(folder);
  std::ofstream(folder / "O0012.nc") << "%\nO0012 (TWO)\nG0 X2.\nM99\n%\n";
  std::ofstream(folder / "0013.nc") << "%\nG0 X3.\nM99\n%\n";
  std::ofstream(folder / "O14") << "G0 X4.\n%\n";
  Config config = fanuc();
  config.subprogram_folders = {folder.string()};
  EXPECT_THAT(fanuc_x_of("M98 P12\nM98 P13\nM30\n", config), ElementsAre(2, 3));
  EXPECT_EQ(reason_of("M98 P14\nM30\n", config), "no_program_end");
  EXPECT_EQ(reason_of("M98 P15\nM30\n", config), "no_such_program");
  fs::remove_all(folder);
}

TEST(Macro, EndsWhereAControlWouldStop) {
  EXPECT_EQ(reason_of("M98P2\nM30\nO2\nM98P2\nM99\n", fanuc()), "calls_too_deep");
  EXPECT_EQ(reason_of("G0X1.\nM99\n", fanuc()), "endless_program");
  EXPECT_EQ(reason_of("M98P2\nM30\nO2\nG0X1.\nO3\nM99\n", fanuc()), "no_program_end");
}

TEST(Macro, RefusesComparisonsOutsideConditions) {
  EXPECT_EQ(reason_of("#1=[1EQ2]\nM30\n", fanuc()), "flow_control");
}

TEST(Macro, KeepsAssignmentsApartFromOtherWords) {
  EXPECT_EQ(reason_of("G0X1.#1=2\nM30\n", fanuc()), "macro_statement");
  EXPECT_EQ(reason_of("#1=2 G0X1.\nM30\n", fanuc()), "macro_statement");
  EXPECT_EQ(reason_of("#1=2\nG20X#1\nM30\n", fanuc()), "units_beside_variables");
  EXPECT_EQ(reason_of("#1=2\nF#1S[ROUND[#1]]\nM30\n", fanuc()), "function_not_interpreted");
}

TEST(Macro, NestsBracketsFiveDeep) {
  EXPECT_EQ(macro_value_of("SIN[[[[0+1]*0]+0]*9]"), 0.0);  // the manual's own example has five
  EXPECT_EQ(reason_of("#1=[[[[[[1]]]]]]\nM30\n", fanuc()), "expression_too_deep");
}

}  // namespace
}  // namespace steadyrest::nc::interpret
