// SPDX-License-Identifier: Apache-2.0
#include <map>
#include <string>

#include <gtest/gtest.h>

#include <steadyrest/nc/read/sinumerik/test/sinumerik_value.hpp>

namespace steadyrest::nc::read {
namespace {

using test::sinumerik_value;

std::string sinumerik_fault(const std::string& text) {
  const test::MapValues values{{{1, 2.0}}, {{"width", 20.0}}};
  SinumerikExpression expression(text, 0, values);
  double value = 0.0;
  return expression.read(value) ? "" : std::string{expression.reason()};
}

TEST(SinumerikExpression, ReadsParametersVariablesAndTruth) {
  const std::map<std::string, double> cases = {
      {"R1", 2},        {"R[R1]", 7.5},   {"r[ R1 - 1 ]", 2}, {"Width/R1", 10},
      {"TRUE+TRUE", 2}, {"NOT FALSE", 1}, {"NOT NOT 5", 1},   {"not R1==0", 1},
      {"-R2--R2", 0},   {"17 MOD 5", 2},  {"17.5 DIV 5", 3}};
  for (const auto& [text, expected] : cases) {
    EXPECT_EQ(sinumerik_value(text), expected) << text;
  }
}

TEST(SinumerikExpression, NestsSixtyFourDeepWithSignsAndBracketsTogether) {
  EXPECT_EQ(sinumerik_value(std::string(64, '-') + "3"), 3.0);
  EXPECT_EQ(
      sinumerik_value(std::string(32, '-') + std::string(32, '(') + "3" + std::string(32, ')')),
      3.0);
  EXPECT_EQ(sinumerik_fault(std::string(65, '-') + "3"), "expression_too_deep");
  EXPECT_EQ(sinumerik_fault(std::string(65, '(') + "3"), "expression_too_deep");
  std::string beside = "3";
  for (int i = 0; i < 100; ++i) {
    beside += "+(-SIN(0))";
  }
  EXPECT_EQ(sinumerik_value(beside), 3.0);
}

TEST(SinumerikExpression, IsRefusedByName) {
  const std::map<std::string, std::string> cases = {{"'B101'", "bad_value"},
                                                    {"\"A\"", "bad_value"},
                                                    {"$AA_IM", "system_variable"},
                                                    {"B_NOT 5", "function_not_interpreted"},
                                                    {"SIN(30", "unclosed_expression"},
                                                    {"SIN(1,2)", "unclosed_expression"},
                                                    {"ATAN2(1)", "bad_function"},
                                                    {"SQRT(-1)", "out_of_domain"},
                                                    {"ASIN(1.001)", "out_of_domain"},
                                                    {"LN(0)", "out_of_domain"},
                                                    {"FOO(1)", "unknown_function"},
                                                    {"R3", "unset_parameter"},
                                                    {"R1000", "no_such_parameter"},
                                                    {"R[1.5]", "no_such_parameter"},
                                                    {"R[-1]", "no_such_parameter"},
                                                    {"1.2.3", "bad_number"},
                                                    {"5 DIV 0", "division_by_zero"},
                                                    {"5.5 MOD 2", "not_an_integer"},
                                                    {"-5 DIV 2", "out_of_domain"},
                                                    {"1.5 B_AND 1", "not_an_integer"},
                                                    {"DEPTH", "variable"},
                                                    {"WIDTH[1]", "variable"},
                                                    {"1EX300*1EX300", "not_finite"},
                                                    {"1+", "missing_value"},
                                                    {"1EX301", "bad_number"},
                                                    {"1EX1.5", "bad_number"},
                                                    {"1EXY", "bad_number"}};
  for (const auto& [text, expected] : cases) {
    EXPECT_EQ(sinumerik_fault(text), expected) << text;
  }
}

}  // namespace
}  // namespace steadyrest::nc::read
