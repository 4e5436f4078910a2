// SPDX-License-Identifier: Apache-2.0
// Lines whose Fréchet distance is known in closed form, and tubes a little wider and narrower.
#include <cmath>
#include <optional>

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <rapidcheck/gtest.h>

#include <steadyrest/math/geometry/vector.hpp>
#include <steadyrest/nc/rewrite/tube/stretch.hpp>
#include <steadyrest/nc/rewrite/tube/test/made_moves.hpp>

namespace steadyrest::nc::rewrite {
namespace {

using kernel::signal::Point;
using test::at_line;
using test::made_line;
using ::testing::HasSubstr;

Point random_place() {
  const auto random_mm = [] { return 0.01 * *rc::gen::inRange(-3000, 3000); };
  return {random_mm(), random_mm(), random_mm()};
}

/// The fault of a line in place of another.
std::optional<Stretch::Fault> fault_of_line(Stretch& stretch, const Point& from, const Point& to,
                                            const Point& off) {
  const Point start = math::geometry::add_scaled(from, off, 1.0);
  stretch.begin(from, start);
  stretch.block(at_line(3, made_line(from, to)));
  stretch.fresh(at_line(7, made_line(start, math::geometry::add_scaled(to, off, 1.0))));
  return stretch.close();
}

// Two parallel lines of one length are as far apart as their starts; a tool that need not keep in
// step with the other comes as near as the lines.
RC_GTEST_PROP(Stretch, AShiftedLineIsAsFarAsItsShift, ()) {
  const Point off = math::geometry::scale(random_place(), 0.01);
  const double apart_mm = math::geometry::norm(off);
  const Point from = random_place();
  const Point to = random_place();
  const Point way = math::geometry::subtract(to, from);
  RC_PRE(math::geometry::norm(way) > 0.0);
  const double lines_mm =
      math::geometry::norm(math::geometry::cross(off, way)) / math::geometry::norm(way);
  RC_PRE(lines_mm > 1e-3);
  Stretch wide(apart_mm + 1e-6);
  RC_ASSERT(!fault_of_line(wide, from, to, off).has_value());
  RC_ASSERT(wide.farthest_mm() > lines_mm - 1e-9 && wide.farthest_mm() < apart_mm + 1e-9);
  RC_ASSERT(wide.farthest_line() == 7U);
  Stretch narrow(apart_mm - 1e-6);
  const auto fault = fault_of_line(narrow, from, to, off);
  RC_ASSERT(fault.has_value());
  RC_ASSERT(fault->line == (fault->of_original ? 3U : 7U));
}

TEST(Stretch, RemembersTheFarthestOfAll) {
  Stretch stretch(1.0);
  EXPECT_FALSE(stretch.open());
  EXPECT_FALSE(stretch.close()) << "nothing was begun";
  EXPECT_FALSE(fault_of_line(stretch, {0, 0, 0}, {5, 0, 0}, {0, 0.25, 0}));
  EXPECT_FALSE(stretch.open());
  EXPECT_NEAR(stretch.farthest_mm(), 0.25, 1e-9);
  EXPECT_FALSE(fault_of_line(stretch, {0, 0, 0}, {5, 0, 0}, {0, 0, 0.1}));
  EXPECT_NEAR(stretch.farthest_mm(), 0.25, 1e-9);
  EXPECT_FALSE(fault_of_line(stretch, {0, 0, 0}, {5, 0, 0}, {0, 0, -0.5}));
  EXPECT_NEAR(stretch.farthest_mm(), 0.5, 1e-9);
}

// The order of a path counts: each point of one is near a point of the other, and yet they differ.
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
