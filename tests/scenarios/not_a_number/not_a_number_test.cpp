// SPDX-License-Identifier: Apache-2.0
// The position of an axis reads NaN for 2.4 s in the cut.
#include <cmath>
#include <limits>

#include <gtest/gtest.h>
#include <tests/scenarios/shared/stage.hpp>

namespace steadyrest::scenarios {
namespace {

using kernel::outcome::Reason;

constexpr std::size_t kBegins = 1000;
constexpr std::size_t kEnds = 1600;

TEST(NotANumber, HandsBackBySlewFreezesTheOffsetAndComesBack) {
  Stage stage;
  stage.show = [](std::size_t cycle, kernel::signal::Frame& frame) {
    if (cycle >= kBegins && cycle < kEnds) {
      frame.axis[0].actual_mm = std::numeric_limits<double>::quiet_NaN();
    }
  };
  stage.run(2600);
  const auto& log = stage.log();
  EXPECT_LT(log[kBegins - 1].feed_ratio(), 0.6);
  EXPECT_EQ(stage.named(Reason::input_not_finite, kBegins, kEnds), kEnds - kBegins);
  // At 2 1/s from below 60 % to the panel: over 0.2 s.
  EXPECT_LT(log[kBegins + 20].feed_ratio(), 0.85) << "not at once";
  EXPECT_EQ(log[kEnds - 1].feed_ratio(), 1.0);
  const auto& frozen_mm = log[kBegins].written->offset_mm;
  EXPECT_NE(frozen_mm[2], 0.0);
  for (std::size_t i = kBegins; i < kEnds; ++i) {
    ASSERT_TRUE(log[i].written);
    ASSERT_EQ(log[i].written->offset_mm, frozen_mm) << "in the cut";
  }
  EXPECT_LT(log[2599].feed_ratio(), 0.6) << "it corrects again";
}

TEST(NotANumber, OffsetsAgainstTheContourErrorRampOut) {
  Stage stage({.max_path_offset_mm = 0.5});
  stage.show = [](std::size_t cycle, kernel::signal::Frame& frame) {
    if (cycle >= kBegins && cycle < kEnds) {
      frame.axis[1].command_mm = std::numeric_limits<double>::infinity();
    }
  };
  stage.run(1700);
  const auto size_mm = [&](std::size_t cycle) {
    const auto& mm = stage.log()[cycle].written->path_offset_mm;
    return std::hypot(mm[0], mm[1]);
  };
  EXPECT_GT(size_mm(kBegins - 1), 0.05);
  EXPECT_GT(size_mm(kBegins), 0.8 * size_mm(kBegins - 1)) << "no jump";
  EXPECT_EQ(size_mm(kEnds - 1), 0.0);
}

}  // namespace
}  // namespace steadyrest::scenarios
