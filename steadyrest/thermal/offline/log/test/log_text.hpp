// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <functional>
#include <string>

#include <fmt/core.h>
#include <gtest/gtest.h>

#include <steadyrest/thermal/offline/log/log.hpp>

/// A log as its text.
namespace steadyrest::thermal::offline::test {

inline constexpr int kRows = 400;

struct Row {
  double time_s = 0.0;
  double speed_rpm = 0.0;
  std::string z;
  std::string t;
};

/// A row each minute; `change` may alter it.
inline std::string log_text(const std::function<void(int, Row&)>& change = {},
                            const std::string& head = "time_s,spindle_rpm,z_um,t1_c") {
  std::string out = head + "\n";
  for (int i = 0; i < kRows; ++i) {
    Row row{60.0 * i, i < 100 ? 1500.0 : 0.0, fmt::format("{:.4f}", 0.1 * i),
            fmt::format("{:.3f}", 20.0 + 0.01 * i)};
    if (change) {
      change(i, row);
    }
    out += fmt::format("{},{},{},{}\n", row.time_s, row.speed_rpm, row.z, row.t);
  }
  return out;
}

inline Log parsed(const std::string& text) {
  auto log = parse_log(text, "day.csv");
  EXPECT_TRUE(log.has_value()) << log.error().what;
  return log ? *log : Log{};
}

}  // namespace steadyrest::thermal::offline::test
