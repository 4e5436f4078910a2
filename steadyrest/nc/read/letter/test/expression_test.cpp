// SPDX-License-Identifier: Apache-2.0
// Expressions. The expected values come from rs274 (LinuxCNC 2.9).
#include <map>
#include <string>

#include <gtest/gtest.h>

#include <steadyrest/nc/read/letter/expression.hpp>

namespace steadyrest::nc::read {
namespace {

class Some final : public Values {
 public:
  [[nodiscard]] Lookup number(int index, double& value) const override {
    value = index == 3 ? 5.0 : index == 5 ? 0.5 : 0.0;
    return index >= 1 && index < 100 ? Lookup::found : Lookup::no_such_number;
  }
  [[nodiscard]] Lookup name(std::string_view name, double& value) const override {
    value = 2.0;
    return name == "ab" ? Lookup::found : Lookup::no_such_name;
  }
  Lookup set_number(int, double) override { return Lookup::read_only; }
  Lookup set_name(std::string_view, double) override { return Lookup::read_only; }
  void commit() override {}
  void drop() noexcept override {}
};

double value_of(const std::string& text) {
  const Some values;
  Expression expression(text, 0, values);
  double value = -12345.0;
  EXPECT_TRUE(expression.read(value)) << text << ": " << expression.text();
  EXPECT_EQ(expression.length(), text.size()) << text;
  return value;
}

std::string reason_of(const std::string& text) {
  const Some values;
  Expression expression(text, 0, values);
  double value = 0.0;
  return expression.read(value) ? "" : std::string{expression.reason()};
}

TEST(Expression, OperatorsBindAsOnTheControl) {
  // A sign binds to its operand, so -2**2 is 4; powers go from left to right, so 2**3**2 is 64;
  // blanks vanish, so 1 2 is 12.
  const std::map<std::string, double> cases = {
      {"[1+2*3**2]", 19},    {"[2**3**2]", 64},      {"[-2**2]", 4},
      {"[7-2-1]", 4},        {"[10 MOD 3]", 1},      {"[-10 MOD 3]", 2},
      {"[5.5 MOD -2]", 1.5}, {"[-5.5 MOD -2]", 0.5}, {"[1 + 2 LT 4 AND 3 GT 2]", 1},
      {"[1 EQ 1.00009]", 1}, {"[1 EQ 1.00011]", 0},  {"[1 NE 1.00009]", 0},
      {"[1 LT 1.00001]", 1}, {"[1 GE 1.00001]", 0},  {"[0.0 OR 0.00000001]", 1},
      {"[2 XOR 1]", 0},      {"[1--1]", 2},          {"[- -1]", 1},
      {"[1 2]", 12},         {"-[1+1]", -2},         {"[1 * * 2]", 1},
      {"[5 MOD 0 NE 2]", 0}, {"[5 MOD 0 EQ 2]", 0},
  };
  for (const auto& [text, expected] : cases) {
    EXPECT_DOUBLE_EQ(value_of(text), expected) << text;
  }
}

TEST(Expression, FunctionsTakeDegrees) {
  EXPECT_DOUBLE_EQ(value_of("ROUND[2.5]"), 3.0);
  EXPECT_DOUBLE_EQ(value_of("ROUND[-2.5]"), -3.0);
  EXPECT_DOUBLE_EQ(value_of("FIX[-1.5]"), -2.0);
  EXPECT_DOUBLE_EQ(value_of("FUP[-1.5]"), -1.0);
  EXPECT_NEAR(value_of("ATAN[1]/[2]"), 26.565051177077990, 1e-12);
  EXPECT_NEAR(value_of("-sin[30]"), -0.5, 1e-15);
  EXPECT_NEAR(value_of("ACOS[0.5]"), 60.0, 1e-12);
  EXPECT_NEAR(value_of("s i n [ 3 0 ]"), 0.5, 1e-15);
}

TEST(Expression, ParametersAreLookedUpThroughEachOther) {
  EXPECT_EQ(value_of("#3"), 5.0);
  EXPECT_EQ(value_of("##3"), 0.5);
  EXPECT_EQ(value_of("#[1+2]"), 5.0);
  // Within 0.0001 an index counts as whole: #1.00005 is #1.
  EXPECT_EQ(value_of("#1.00005"), 0.0);
  EXPECT_EQ(value_of("#<A b>"), 2.0);
  EXPECT_EQ(value_of("EXISTS[#<ab>]"), 1.0);
  EXPECT_EQ(value_of("EXISTS[#<zz>]"), 0.0);
}

TEST(Expression, RefusesWhatHasNoValue) {
  const std::map<std::string, std::string> cases = {
      {"[1/0]", "division_by_zero"},
      // An infinity or not a number must never become a coordinate.
      {"[5 MOD 0]", "not_finite"},
      {"[0**-1]", "not_finite"},
      {"[-8**[1/3]]", "not_finite"},
      {"SQRT[-1]", "out_of_domain"},
      {"LN[0]", "out_of_domain"},
      {"ACOS[1.0000001]", "out_of_domain"},
      {"[1", "unclosed_expression"},
      {"[]", "missing_value"},
      {"[1+]", "missing_value"},
      {"#<zz>", "unset_parameter"},
      {"#500", "no_such_parameter"},
      {"#[1.5]", "not_an_integer"},
      {"SINH[1]", "unknown_function"},
      {"ATAN[1]", "bad_function"},
      {"#<>", "bad_parameter"},
      {"", "missing_value"},
      {std::string(300, '['), "expression_too_deep"},
      {std::string(300, '#') + "1", "expression_too_deep"},
  };
  for (const auto& [text, expected] : cases) {
    EXPECT_EQ(reason_of(text), expected) << text.substr(0, 20);
  }
}

}  // namespace
}  // namespace steadyrest::nc::read
