// SPDX-License-Identifier: Apache-2.0
// The places that part what is learnt on one side from the other.
#include <cmath>

#include <gtest/gtest.h>

#include <steadyrest/contour/offline/learn/sharp_corners.hpp>
#include <steadyrest/contour/online/test/paths.hpp>

namespace steadyrest::contour::offline {
namespace {

using kernel::signal::Motion;
using online::test::PathMaker;

/// 10 mm along X, then 10 mm at this angle to it.
SharpCorners corners_of_bend(double angle_rad) {
  return sharp_corners(
      PathMaker({0, 0, 0}, 20.0)
          .line_to({10, 0, 0})
          .line_to({10.0 + 10.0 * std::cos(angle_rad), 10.0 * std::sin(angle_rad), 0})
          .path());
}

// |t′ − t| = 2·sin(φ/2) is 0.3 at φ = 0.30114, 17.25°.
TEST(SharpCornersOfAPath, AreBendsOfMoreThanSeventeenDegrees) {
  EXPECT_FALSE(corners_of_bend(0.300).between(9.0, 11.0));
  EXPECT_TRUE(corners_of_bend(0.302).between(9.0, 11.0));
  EXPECT_TRUE(corners_of_bend(-0.302).between(9.0, 11.0));
  EXPECT_TRUE(corners_of_bend(3.14).between(9.0, 11.0));
}

// A half circle turns by π, but nowhere at once.
TEST(SharpCornersOfAPath, AreNotWhereALineRunsIntoAnArc) {
  const SharpCorners corners =
      sharp_corners(PathMaker({0, 0, 0}, 20.0).line_to({10, 0, 0}).arc({10, 5, 0}, 3.0).path());
  EXPECT_FALSE(corners.between(0.1, 24.9));
  EXPECT_TRUE(corners.between(24.9, 25.0));
}

TEST(SharpCornersOfAPath, AreWhereACutBeginsAndEnds) {
  const SharpCorners corners = sharp_corners(PathMaker({0, 0, 0}, 20.0)
                                                 .line_to({10, 0, 0})
                                                 .motion(Motion::rapid)
                                                 .line_to({20, 0, 0})
                                                 .motion(Motion::feed)
                                                 .line_to({30, 0, 0})
                                                 .path());
  for (const double at_mm : {0.0, 10.0, 20.0, 30.0}) {
    EXPECT_EQ(corners.before(at_mm + 4.0), at_mm);
    EXPECT_EQ(corners.after(at_mm - 4.0), at_mm);
  }
}

// A corner is before and after itself; between is behind the first place, up to the second.
TEST(SharpCornersOfAPath, CountForTheStretchThatReachesThem) {
  const SharpCorners corners({10.0, 20.0});
  EXPECT_EQ(corners.before(10.0), 10.0);
  EXPECT_EQ(corners.after(10.0), 10.0);
  EXPECT_TRUE(corners.between(9.0, 10.0));
  EXPECT_FALSE(corners.between(10.0, 19.9));
  EXPECT_TRUE(corners.between(5.0, 25.0));
}

// Outside of all corners a place is its own bound.
TEST(SharpCornersOfAPath, OutsideOfThemAPlaceStaysWhereItIs) {
  const SharpCorners corners({10.0, 20.0});
  EXPECT_EQ(corners.before(4.0), 4.0);
  EXPECT_EQ(corners.after(25.0), 25.0);
  EXPECT_FALSE(corners.between(21.0, 99.0));
  const SharpCorners none = sharp_corners({});
  EXPECT_EQ(none.before(3.0), 3.0);
  EXPECT_EQ(none.after(3.0), 3.0);
  EXPECT_FALSE(none.between(0.0, 1e9));
}

}  // namespace
}  // namespace steadyrest::contour::offline
