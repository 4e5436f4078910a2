// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>

#include <gtest/gtest.h>

#include <steadyrest/nc/read/sinumerik/sinumerik_expression.hpp>
#include <steadyrest/nc/read/test/map_values.hpp>

namespace steadyrest::nc::read::test {

/// R1 = 2, R2 = 7.5, WIDTH = 20.
inline double sinumerik_value(const std::string& text) {
  const MapValues values{{{1, 2.0}, {2, 7.5}}, {{"width", 20.0}}};
  SinumerikExpression expression(text, 0, values);
  double value = -12345.0;
  EXPECT_TRUE(expression.read(value)) << text << ": " << expression.text();
  EXPECT_EQ(expression.length(), text.size()) << text;
  return value;
}

}  // namespace steadyrest::nc::read::test
