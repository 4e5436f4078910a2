// SPDX-License-Identifier: Apache-2.0
// The order of a path counts: each point of one is near a point of the other, and yet they differ.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <steadyrest/nc/rewrite/tube/stretch.hpp>
#include <steadyrest/nc/rewrite/tube/test/made_moves.hpp>

namespace steadyrest::nc::rewrite {
namespace {

using test::at_line;
using test::made_line;
using ::testing::HasSubstr;

// Whoever waits for a tool that goes back by s is at best s/2 from it.
TEST(StretchOrder, AStepBackIsHalfItsLengthFromTheLine) {
  constexpr double kBack_mm = 3.0;
  const auto fault = [](double tube_mm) {
    Stretch stretch(tube_mm);
    stretch.begin({0, 0, 0}, {0, 0, 0});
    stretch.block(made_line({0, 0, 0}, {10, 0, 0}));
    stretch.fresh(made_line({0, 0, 0}, {6, 0, 0}));
    stretch.fresh(made_line({6, 0, 0}, {6 - kBack_mm, 0, 0}));
    stretch.fresh(made_line({6 - kBack_mm, 0, 0}, {10, 0, 0}));
    return stretch.close();
  };
  EXPECT_FALSE(fault(0.5 * kBack_mm + 1e-6));
  ASSERT_TRUE(fault(0.5 * kBack_mm - 1e-6));
  EXPECT_THAT(fault(0.5 * kBack_mm - 1e-6)->what, HasSubstr("it turns back"));
}

// A slot of depth h that is passed over is h from the path, in the original's own line.
TEST(StretchOrder, ASlotThatIsPassedOverIsLeftOutByItsDepth) {
  constexpr double kDepth_mm = 2.0;
  const auto fault = [](double tube_mm) {
    Stretch stretch(tube_mm);
    stretch.begin({0, 0, 0}, {0, 0, 0});
    stretch.block(at_line(4, made_line({0, 0, 0}, {10, 0, 0})));
    stretch.fresh(made_line({0, 0, 0}, {10, 0, 0}));
    stretch.block(at_line(5, made_line({10, 0, 0}, {10, 0, -kDepth_mm})));
    stretch.block(at_line(6, made_line({10, 0, -kDepth_mm}, {10, 0, 0})));
    stretch.block(at_line(7, made_line({10, 0, 0}, {20, 0, 0})));
    stretch.fresh(made_line({10, 0, 0}, {20, 0, 0}));
    return stretch.close();
  };
  EXPECT_FALSE(fault(kDepth_mm + 1e-6));
  const auto narrow = fault(kDepth_mm - 1e-6);
  ASSERT_TRUE(narrow);
  EXPECT_TRUE(narrow->of_original);
  EXPECT_EQ(narrow->line, 5U);
  EXPECT_THAT(narrow->what, HasSubstr("left out by 2.000000 mm at X10.0000 Y0.0000 Z-2.0000"));
}

}  // namespace
}  // namespace steadyrest::nc::rewrite
