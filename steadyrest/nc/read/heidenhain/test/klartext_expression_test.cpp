// SPDX-License-Identifier: Apache-2.0
// Formulas of Klartext. Values with a result are the manual's own ("Entering formulas directly",
// "Programming: Q parameters").
#include <cmath>
#include <string>

#include <gtest/gtest.h>

#include <steadyrest/nc/read/heidenhain/klartext_expression.hpp>
#include <steadyrest/nc/read/heidenhain/klartext_value.hpp>
#include <steadyrest/nc/read/test/map_values.hpp>

namespace steadyrest::nc::read {
namespace {

/// Q1 = 2, Q2 = 7.5.
double klartext_value(const std::string& text) {
  const test::MapValues values{{{1, 2.0}, {2, 7.5}}};
  KlartextExpression expression(text, 0, values);
  double value = -12345.0;
  EXPECT_TRUE(expression.read(value)) << text << ": " << expression.text();
  EXPECT_EQ(expression.length(), text.size()) << text;
  return value;
}

std::string klartext_reason(const std::string& text) {
  const test::MapValues values{{{1, 2.0}, {2, 7.5}}};
  KlartextExpression expression(text, 0, values);
  double value = 0.0;
  return expression.read(value) ? std::string{} : std::string{expression.reason()};
}

TEST(KlartextExpression, FollowsTheManualsRules) {
  EXPECT_DOUBLE_EQ(klartext_value("5 * 3 + 2 * 10"), 35.0);
  EXPECT_DOUBLE_EQ(klartext_value("SQ 10 - 3^3"), 73.0);
  EXPECT_DOUBLE_EQ(klartext_value("Q1 * ( Q2 + 2,5 )"), 20.0);
}

TEST(KlartextExpression, TakesFunctionsWithAndWithoutBrackets) {
  EXPECT_DOUBLE_EQ(klartext_value("SIN 30"), 0.5);
  EXPECT_DOUBLE_EQ(klartext_value("COS(60)"), 0.5);
  EXPECT_DOUBLE_EQ(klartext_value("ATAN 1"), 45.0);
  EXPECT_DOUBLE_EQ(klartext_value("SQRT SQ Q2"), 7.5);
  EXPECT_DOUBLE_EQ(klartext_value("NEG Q1 + ABS -3"), 1.0);
  EXPECT_DOUBLE_EQ(klartext_value("INT 42.7 + FRAC 42.25"), 42.25);
  EXPECT_DOUBLE_EQ(klartext_value("SGN -7 + LOG 1000 + LN 1 + EXP 0"), 3.0);
  EXPECT_DOUBLE_EQ(klartext_value("SINQ1"), std::sin(2.0 * 3.14159265358979323846 / 180.0));
}

TEST(KlartextExpression, TakesSignsWithTheirOperand) {
  EXPECT_DOUBLE_EQ(klartext_value("5 * -3"), -15.0);
  EXPECT_DOUBLE_EQ(klartext_value("-Q1 + +Q2"), 5.5);
  EXPECT_DOUBLE_EQ(klartext_value("10 - 4 - 3"), 3.0);
  EXPECT_DOUBLE_EQ(klartext_value("7 % 4"), 3.0);
}

TEST(KlartextExpression, RefusesWhatIsNotCertain) {
  EXPECT_EQ(klartext_reason("-3^2"), "sign_before_power");
  EXPECT_EQ(klartext_reason("Q9"), "unset_parameter");
  EXPECT_EQ(klartext_reason("Q99999"), "no_such_parameter");
  EXPECT_EQ(klartext_reason("1 / 0"), "not_finite");
  EXPECT_EQ(klartext_reason("( 1 + 2"), "unclosed_expression");
  EXPECT_EQ(klartext_reason("FOO 1"), "unknown_function");
  EXPECT_EQ(klartext_reason("1 +"), "missing_value");
  EXPECT_EQ(klartext_reason(std::string(100, '(') + "1"), "nested_too_deep");
}

TEST(KlartextNumber, HasAPointOrAComma) {
  EXPECT_DOUBLE_EQ(read_klartext_number("+10,5 Y").value, 10.5);
  EXPECT_DOUBLE_EQ(read_klartext_number("-.25").value, -0.25);
  EXPECT_EQ(read_klartext_number("+10,5 Y").length, 5U);
  EXPECT_EQ(read_klartext_number("Q5").length, 0U);
}

TEST(KlartextParameter, HasThreeKinds) {
  EXPECT_EQ(read_q_name("Q15=").index, 15);
  EXPECT_EQ(read_q_name("QL3 ").index, kFirstLocalQ + 3);
  EXPECT_EQ(read_q_name("qr7").index, kFirstKeptQ + 7);
  EXPECT_EQ(read_q_name("QS1").length, 0U);
}

}  // namespace
}  // namespace steadyrest::nc::read
