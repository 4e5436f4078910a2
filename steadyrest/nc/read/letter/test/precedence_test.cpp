// SPDX-License-Identifier: Apache-2.0
#include <cmath>
#include <functional>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include <steadyrest/nc/read/letter/expression.hpp>
#include <steadyrest/nc/read/letter/macro_expression.hpp>
#include <steadyrest/nc/read/test/map_values.hpp>
#include <steadyrest/nc/read/test/operators.hpp>

namespace steadyrest::nc::read {
namespace {

using test::ListedSign;
using test::on_bits;

double power_of(double a, double b) {
  return std::pow(a, b);
}

// LinuxCNC, "Binary Operators": ** first; * / MOD; + -; comparisons; AND OR XOR.
TEST(Precedence, OfLinuxcncHasFiveLevels) {
  const std::vector<ListedSign> table = {{"**", 5, power_of},
                                         {"*", 4, std::multiplies<>{}},
                                         {"+", 3, std::plus<>{}},
                                         {"-", 3, std::minus<>{}},
                                         {"LT", 2, std::less<>{}},
                                         {"GE", 2, std::greater_equal<>{}},
                                         {"EQ", 2, std::equal_to<>{}},
                                         {"AND", 1, std::logical_and<>{}},
                                         {"OR", 1, std::logical_or<>{}},
                                         {"XOR", 1, test::truth_of_xor}};
  test::expect_the_order_of(table, [](const std::string& text) {
    const test::MapValues values;
    const std::string whole = '[' + text + ']';
    double value = std::nan("");
    Expression(whole, 0, values).read(value);
    return value;
  });
}

// FANUC Series 30i, "Arithmetic and logic operation": functions; * / AND; + - OR XOR.
TEST(Precedence, OfFanucHasTwoLevels) {
  const std::vector<ListedSign> table = {{"*", 2, std::multiplies<>{}},
                                         {"AND", 2, on_bits(std::bit_and<>{})},
                                         {"+", 1, std::plus<>{}},
                                         {"OR", 1, on_bits(std::bit_or<>{})},
                                         {"XOR", 1, on_bits(std::bit_xor<>{})}};
  test::expect_the_order_of(table, [](const std::string& text) {
    const test::MapValues values;
    double value = std::nan("");
    MacroExpression(text, 0, values, 1.0).read_sum(value);
    return value;
  });
}

}  // namespace
}  // namespace steadyrest::nc::read
