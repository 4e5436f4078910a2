// SPDX-License-Identifier: Apache-2.0
// SINUMERIK 840D sl, "Job planning": arithmetic operations, comparisons and their priority.
#include <cstdlib>
#include <functional>
#include <map>
#include <string>
#include <utility>
#include <vector>

#include <fmt/core.h>
#include <gtest/gtest.h>
#include <rapidcheck.h>

#include <steadyrest/nc/read/sinumerik/test/sinumerik_value.hpp>
#include <steadyrest/nc/read/test/operators.hpp>

namespace steadyrest::nc::read {
namespace {

using test::on_bits;
using test::sinumerik_value;

// "Priority of the operations": * /; + -; B_AND; B_XOR; B_OR; AND; XOR; OR; comparisons.
TEST(SinumerikArithmetic, HasNineLevelsOfOperators) {
  const std::vector<test::ListedSign> table = {
      {"*", 9, std::multiplies<>{}},           {"+", 8, std::plus<>{}},
      {"B_AND", 7, on_bits(std::bit_and<>{})}, {"B_XOR", 6, on_bits(std::bit_xor<>{})},
      {"B_OR", 5, on_bits(std::bit_or<>{})},   {"AND", 4, std::logical_and<>{}},
      {"XOR", 3, test::truth_of_xor},          {"OR", 2, std::logical_or<>{}},
      {"<>", 1, std::not_equal_to<>{}},        {"<", 1, std::less<>{}},
      {">=", 1, std::greater_equal<>{}}};
  test::expect_the_order_of(table, sinumerik_value);
}

TEST(SinumerikArithmetic, LogicWithBWorksOnTheBitsOfWholeNumbers) {
  test::expect_logic_of_bits(sinumerik_value, "B_");
}

// EX is the power of ten; the C library's conversion is correctly rounded.
TEST(SinumerikArithmetic, APowerOfTenIsTheDoubleThatTheCLibraryGives) {
  EXPECT_TRUE(rc::check([] {
    const std::string mantissa =
        fmt::format("{}.{}", *rc::gen::inRange(0, 1000000), *rc::gen::inRange(0, 1000000));
    const int power = *rc::gen::inRange(-300, 301);
    const std::string sign = power < 0 ? "" : *rc::gen::element<std::string>("", "+");
    const std::string in_c = fmt::format("{}e{}", mantissa, power);
    RC_ASSERT(sinumerik_value(fmt::format("{}EX{}{}", mantissa, sign, power)) ==
              std::strtod(in_c.c_str(), nullptr));
  }));
}

// The manual: relative equality to 10⁻¹². Both sides of the bound, and every comparison.
TEST(SinumerikArithmetic, EqualMeansWithinAMillionthOfAMillionth) {
  const std::map<std::string, std::pair<double, double>> cases = {
      {"==", {1, 0}}, {"<>", {0, 1}}, {"<", {0, 1}}, {"<=", {1, 1}}, {">", {0, 0}}, {">=", {1, 0}}};
  for (const auto& [sign, expected] : cases) {
    EXPECT_EQ(sinumerik_value("5000" + sign + "5000.000000004"), expected.first) << sign;
    EXPECT_EQ(sinumerik_value("5000" + sign + "5000.000000006"), expected.second) << sign;
  }
}

}  // namespace
}  // namespace steadyrest::nc::read
