// SPDX-License-Identifier: Apache-2.0
// The machine warms up in a long cut: the offset against heat grows beyond the contour limit, and
// the contour room does not take it for a contour error.
#include <algorithm>
#include <cmath>

#include <gtest/gtest.h>
#include <tests/scenarios/shared/stage.hpp>

namespace steadyrest::scenarios {
namespace {

TEST(HeatInTheCut, TheOffsetAgainstItDoesNotSlowTheFeed) {
  Stage stage;
  stage.run(4000);
  const auto& log = stage.log();
  EXPECT_GT(std::abs(log[3999].written->offset_mm[0]), 0.01);
  const auto& axis = log[3999].frame.axis;
  EXPECT_NEAR(axis[0].offset_mm, log[3998].written->offset_mm[0], 1e-3);
  EXPECT_NEAR(
      std::hypot(axis[0].command_mm - axis[0].offset_mm, axis[1].command_mm - axis[1].offset_mm),
      10.0, 1e-3)
      << "it is in what the control reports";
  double lowest = 1.0;
  double largest_mm = 0.0;
  for (std::size_t i = 3000; i < 4000; ++i) {
    lowest = std::min(lowest, log[i].feed_ratio());
    largest_mm = std::max(largest_mm, std::abs(log[i].status.contour_error_mm));
  }
  // 10 µm on R 10 with k = 50 1/s: v = k·√(2·R·ε) = 22 mm/s of 67, less the margin.
  EXPECT_GE(lowest, 0.2);
  EXPECT_LE(largest_mm, 1.1 * stage.machine().contour.limit_mm);
}

}  // namespace
}  // namespace steadyrest::scenarios
