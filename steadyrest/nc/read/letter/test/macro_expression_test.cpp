// SPDX-License-Identifier: Apache-2.0
// FANUC Series 30i operator's manual, "Arithmetic and logic operation".
#include <cmath>
#include <map>
#include <string>

#include <fmt/core.h>
#include <gtest/gtest.h>

#include <steadyrest/kernel/units/constants.hpp>
#include <steadyrest/nc/read/letter/macro_expression.hpp>
#include <steadyrest/nc/read/test/map_values.hpp>
#include <steadyrest/nc/read/test/operators.hpp>

namespace steadyrest::nc::read {
namespace {

double macro_value(const std::string& text, double increment = 1.0) {
  const test::MapValues values;
  MacroExpression expression(text, 0, values, increment);
  double value = -12345.0;
  EXPECT_TRUE(expression.read_sum(value)) << text << ": " << expression.text();
  EXPECT_EQ(expression.length(), text.size()) << text;
  return value;
}
std::string macro_fault(const std::string& text, double increment = 1.0) {
  const test::MapValues values;
  MacroExpression expression(text, 0, values, increment);
  double value = 0.0;
  return expression.read_sum(value) ? "" : std::string{expression.reason()};
}

TEST(MacroExpression, LogicWorksOnTheBitsOfWholeNumbers) {
  test::expect_logic_of_bits([](const std::string& text) { return macro_value(text); }, "");
}

TEST(MacroExpression, TakesTheFirstTwoLettersForAFunction) {
  const std::map<std::string, double> cases = {
      {"SI[30]", 0.5},  {"CO[60]", 0.5}, {"TA[45]", 1},   {"AS[1]", 90},  {"AC[0]", 90},
      {"AT[1]", 45},    {"SQ[9]", 3},    {"AB[-2]", 2},   {"RO[2.5]", 3}, {"FI[-1.5]", -1},
      {"FU[-1.5]", -2}, {"EX[0]", 1},    {"si[30]", 0.5}, {"LN[1]", 0}};
  for (const auto& [text, expected] : cases) {
    EXPECT_NEAR(macro_value(text), expected, 1e-12) << text;
  }
  for (const char* text : {"S[30]", "SQR[9]", "ROUN[1]", "SINH[1]"}) {
    EXPECT_EQ(macro_fault(text), "unknown_function") << text;
  }
}

// Parameter 6004#0 = 0: ATAN[y]/[x] is 0° to 360°.
TEST(MacroExpression, TheArcTangentOfTwoValuesGoesRoundTheWholeCircle) {
  for (int angle_deg = 0; angle_deg < 360; angle_deg += 15) {
    const double angle = angle_deg * kernel::units::kDegree;
    for (const char* form : {"ATAN[{:.12f}]/[{:.12f}]", "ATAN[{:.12f},{:.12f}]"}) {
      const std::string text =
          fmt::format(fmt::runtime(form), 7.0 * std::sin(angle), 7.0 * std::cos(angle));
      EXPECT_NEAR(std::remainder(macro_value(text) - angle_deg, 360.0), 0.0, 1e-9) << text;
      EXPECT_GE(macro_value(text), 0.0) << text;
    }
  }
}

TEST(MacroExpression, RoundGoesToTheIncrementOfItsAddress) {
  EXPECT_DOUBLE_EQ(macro_value("ROUND[1.00333]", 0.001), 1.003);
  EXPECT_DOUBLE_EQ(macro_value("ROUND[1.00333]", 0.0001), 1.0033);
  EXPECT_DOUBLE_EQ(macro_value("ROUND[-1.0005001]", 0.001), -1.001);
  EXPECT_EQ(macro_fault("ROUND[1.00333]", 0.0), "function_not_interpreted");
}

TEST(MacroExpression, CountsTheBracketsOfFunctionsAmongTheFive) {
  EXPECT_NEAR(macro_value("ABS[ATAN[ABS[ATAN[[1]]]]]"), std::atan(45.0) / kernel::units::kDegree,
              1e-12);
  EXPECT_EQ(macro_fault("ABS[ATAN[ABS[ATAN[[[1]]]]]]"), "expression_too_deep");
  EXPECT_EQ(macro_value("[1]+[1]+[1]+[1]+[1]+[1]+ABS[1]+ATAN[0]"), 7.0);  // beside each other
}

TEST(MacroExpression, IsRefusedByName) {
  const std::map<std::string, std::string> cases = {{"5MOD0", "division_by_zero"},
                                                    {"1.5AND1", "not_an_integer"},
                                                    {"-1OR1", "not_an_integer"},
                                                    {"2147483648XOR1", "not_an_integer"},
                                                    {"SQRT[-1]", "out_of_domain"},
                                                    {"LN[0]", "out_of_domain"},
                                                    {"ASIN[1.1]", "out_of_domain"},
                                                    {"ATAN[0]/[0]", "out_of_domain"},
                                                    {"POW[2,3]", "function_not_interpreted"},
                                                    {"##1", "bad_parameter"},
                                                    {"#[1.5]", "not_an_integer"},
                                                    {"#1", "vacant_variable"},
                                                    {"#99999", "no_such_parameter"},
                                                    {"[1", "unclosed_expression"},
                                                    {"1+", "missing_value"}};
  for (const auto& [text, expected] : cases) {
    EXPECT_EQ(macro_fault(text), expected) << text;
  }
}

}  // namespace
}  // namespace steadyrest::nc::read
