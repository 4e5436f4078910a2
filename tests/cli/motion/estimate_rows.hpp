// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstdlib>
#include <sstream>
#include <string>
#include <vector>

#include "scratch.hpp"
#include <gtest/gtest.h>

/// The rows that `motion estimate` has written.
namespace steadyrest::test {

inline const std::string kAxis = " --count-mm 0.001 --cycle-hz 1000";
inline const std::string kTicks = " --input ticks" + kAxis;
inline const std::string kColumns =
    "t_s,position_mm,velocity_mm_s,acceleration_mm_s2,velocity_bound_mm_s,"
    "acceleration_bound_mm_s2";

using Row = std::array<double, 6>;

inline std::vector<Row> estimated_rows(const std::string& table) {
  std::istringstream in(table);
  std::string line;
  std::getline(in, line);
  EXPECT_EQ(line, kColumns);
  std::vector<Row> out;
  while (std::getline(in, line)) {
    std::istringstream fields(line);
    std::string field;
    Row row{};
    for (double& value : row) {
      EXPECT_TRUE(std::getline(fields, field, ',')) << line;
      value = std::strtod(field.c_str(), nullptr);
    }
    EXPECT_TRUE(fields.eof()) << line;
    out.push_back(row);
  }
  return out;
}

}  // namespace steadyrest::test
