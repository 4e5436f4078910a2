// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <cmath>
#include <limits>
#include <vector>

#include <gtest/gtest.h>

#include <steadyrest/motion/offline/scene/test/learnt_lines.hpp>
#include <steadyrest/motion/offline/test/scenes.hpp>
#include <steadyrest/motion/online/line/line_table.hpp>

namespace steadyrest::motion::offline::test {
namespace {

using online::LineTable;

double largest(const std::vector<double>& values) {
  double out = 0.0;
  for (const double v : values) {
    out = std::max(out, std::abs(v));
  }
  return out;
}

// A hundred passes over ideal lines: the table learns only the fits' own error, which is not
// applied.
TEST(LineTable, AnIdealScaleStaysAsItIs) {
  LineTable table = table_of(-10, 2100);
  learn(table, long_sine_ideal(), 100);
  EXPECT_LT(largest(table.error_mm()), 0.01 * 0.001);
  for (int line = -20; line < 2100; ++line) {
    EXPECT_DOUBLE_EQ(table.position_mm(line), line * 0.001);
    EXPECT_LT(table.sigma_mm(line), 0.0);
  }
}

TEST(LineTable, ASmoothErrorOfScaleIsNotInvented) {
  // A scale that stretches by 20 µm/m and a bend of ±2 counts over 2000 lines: smooth over the
  // window, so the lines look ideal.
  Profile bent = sine(1.0, 2.0, 4.0);
  const auto truth = bent.at;
  bent.at = [truth](double t) {
    MotionState s = truth(t);
    s.position_mm += 20e-6 * s.position_mm + 0.002 * std::sin(3.14159 * s.position_mm);
    return s;
  };
  const Record record = offline::record(bent, {});
  LineTable table = table_of(-10, 2100);
  learn(table, record, 50);
  EXPECT_LT(largest(table.error_mm()), 0.02 * 0.001);
  EXPECT_DOUBLE_EQ(table.position_mm(700), 0.7);
}

// The fit's RMS must stop it, not the test's patience.
TEST(LineTable, RoughMotionTeachesNothing) {
  // Stamps with noise of 2 counts of travel: no fit is good enough.
  LineTable table = table_of(0, 1000);
  for (int line = 0; line < 900; ++line) {
    table.learn(line * 1e-4 + (line * 7919 % 13) * 1.5e-5, line, 1, false);
  }
  EXPECT_EQ(table.fits(), 0U);
  EXPECT_EQ(largest(table.error_mm()), 0.0);
}

TEST(LineTable, UnfitInputTeachesNothing) {
  LineTable table = table_of(0, 200);
  const double nan = std::numeric_limits<double>::quiet_NaN();
  for (int line = 0; line < 200; ++line) {
    table.learn(line % 10 == 3 ? nan : line * 1e-4, line, 1, false);
    table.learn(std::numeric_limits<double>::infinity(), std::numeric_limits<std::int64_t>::max(),
                0, false);
  }
  EXPECT_EQ(table.fits(), 0U);
  for (int line = 0; line < 200; ++line) {
    EXPECT_DOUBLE_EQ(table.position_mm(line), line * 0.001);
  }
}

}  // namespace
}  // namespace steadyrest::motion::offline::test
