// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <functional>
#include <string>
#include <vector>

#include <gtest/gtest.h>
#include <rapidcheck.h>

/// What the manuals say about operators, taken literally.
namespace steadyrest::nc::read::test {

struct ListedSign {
  std::string name;
  int strength = 0;
  std::function<double(double, double)> law;
};

inline double truth_of_xor(double a, double b) {
  return (a != 0.0) != (b != 0.0) ? 1.0 : 0.0;
}
/// On the bits of whole numbers.
template <class Law>
std::function<double(double, double)> on_bits(Law law) {
  return [law](double a, double b) {
    return static_cast<double>(law(static_cast<unsigned>(a), static_cast<unsigned>(b)));
  };
}

/// Of the strongest signs that are left, the first is carried out.
inline double by_strength(std::vector<double> values, std::vector<const ListedSign*> signs) {
  while (!signs.empty()) {
    const auto first =
        std::ranges::max_element(signs, {}, [](const ListedSign* sign) { return sign->strength; });
    const auto left = values.begin() + (first - signs.begin());
    *left = (*first)->law(left[0], left[1]);
    values.erase(left + 1);
    signs.erase(first);
  }
  return values.front();
}

using ValueOf = std::function<double(const std::string& text)>;

/// A row of numbers with signs between them has the value that the table gives it.
inline void expect_row(const std::vector<double>& values,
                       const std::vector<const ListedSign*>& signs, const ValueOf& value_of) {
  std::string text = std::to_string(static_cast<int>(values[0]));
  for (std::size_t i = 0; i < signs.size(); ++i) {
    text += ' ' + signs[i]->name + ' ' + std::to_string(static_cast<int>(values[i + 1]));
  }
  EXPECT_EQ(value_of(text), by_strength(values, signs)) << text;
}

/// All pairs of signs between numbers from 1 to 3, and random rows of four to six numbers.
inline void expect_the_order_of(const std::vector<ListedSign>& table, const ValueOf& value_of) {
  for (std::size_t i = 0; i < table.size() * table.size(); ++i) {
    for (int j = 0; j < 27; ++j) {
      const int second = j / 3 % 3;
      const int third = j / 9;
      expect_row({1.0 + j % 3, 1.0 + second, 1.0 + third},
                 {&table[i / table.size()], &table[i % table.size()]}, value_of);
    }
  }
  EXPECT_TRUE(rc::check([&] {
    std::vector<double> values = {static_cast<double>(*rc::gen::inRange(1, 4))};
    std::vector<const ListedSign*> signs;
    for (int i = *rc::gen::inRange(3, 6); i > 0; --i) {
      signs.push_back(&table[*rc::gen::inRange<std::size_t>(0, table.size())]);
      values.push_back(*rc::gen::inRange(1, 4));
    }
    expect_row(values, signs, value_of);
  }));
}

/// a + b = (a or b) + (a and b), bit by bit; exclusive or is `or` without `and`.
inline void expect_logic_of_bits(const ValueOf& value_of, const std::string& prefix) {
  EXPECT_TRUE(rc::check([&] {
    const auto a = *rc::gen::inRange<std::int64_t>(0, 2147483648);
    const auto b = *rc::gen::inRange<std::int64_t>(0, 2147483648);
    const auto with = [&](const char* sign) {
      const std::string text = std::to_string(a) + ' ' + prefix + sign + ' ' + std::to_string(b);
      return static_cast<std::int64_t>(value_of(text));
    };
    RC_ASSERT(with("OR") + with("AND") == a + b);
    RC_ASSERT(with("OR") - with("AND") == with("XOR"));
  }));
  EXPECT_EQ(value_of("12 " + prefix + "AND 10"), 8.0);  // 1100 and 1010 are 1000
}

}  // namespace steadyrest::nc::read::test
