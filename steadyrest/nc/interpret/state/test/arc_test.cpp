// SPDX-License-Identifier: Apache-2.0
#include <cmath>
#include <numbers>

#include <gtest/gtest.h>
#include <rapidcheck.h>

#include <steadyrest/nc/interpret/state/arc.hpp>

namespace steadyrest::nc::interpret {
namespace {

constexpr PlanePoint kOrigin{.first = 0.0, .second = 0.0};

double distance(PlanePoint a, PlanePoint b) {
  return std::hypot(a.first - b.first, a.second - b.second);
}

/// Angle of travel from start to end about the centre, 0 … 2π, in the given direction.
double travel(PlanePoint start, PlanePoint end, PlanePoint centre, bool clockwise) {
  const double from = std::atan2(start.second - centre.second, start.first - centre.first);
  const double to = std::atan2(end.second - centre.second, end.first - centre.first);
  const double angle = clockwise ? from - to : to - from;
  return angle < 0.0 ? angle + 2.0 * std::numbers::pi : angle;
}

// A quarter of the unit circle from (1, 0) to (0, 1): counter-clockwise about the origin. Three
// quarters of it, or clockwise, turn about (1, 1).
TEST(ArcByRadius, HasTheFourCentresOfAQuarter) {
  const PlanePoint start{.first = 1.0, .second = 0.0};
  const PlanePoint end{.first = 0.0, .second = 1.0};
  const auto near = [&](double radius_mm, bool clockwise, double both) {
    const auto centre = centre_from_radius(start, end, radius_mm, clockwise, {});
    ASSERT_TRUE(centre);
    EXPECT_NEAR(centre->first, both, 1e-15);
    EXPECT_NEAR(centre->second, both, 1e-15);
  };
  near(1.0, false, 0.0);
  near(1.0, true, 1.0);
  near(-1.0, false, 1.0);
  near(-1.0, true, 0.0);
}

// For any chord and radius: the centre is at R from both ends, and the arc takes up to half a turn
// for R > 0 and at least that for R < 0.
TEST(ArcByRadius, IsTheShortOrTheLongWayRound) {
  EXPECT_TRUE(rc::check([] {
    const auto coordinate = [] { return *rc::gen::inRange(-9'999, 9'999) / 100.0; };
    const PlanePoint start{.first = coordinate(), .second = coordinate()};
    const PlanePoint end{.first = coordinate(), .second = coordinate()};
    const double chord = distance(start, end);
    RC_PRE(chord > 0.01);
    const double radius = 0.5 * chord * (1.0 + *rc::gen::inRange(1, 400) / 100.0);
    const bool clockwise = *rc::gen::arbitrary<bool>();
    for (const double sign : {1.0, -1.0}) {
      const auto centre = centre_from_radius(start, end, sign * radius, clockwise, {});
      RC_ASSERT(centre.has_value());
      RC_ASSERT(std::abs(distance(*centre, start) - radius) < 1e-9 * radius);
      RC_ASSERT(std::abs(distance(*centre, end) - radius) < 1e-9 * radius);
      const double angle = travel(start, end, *centre, clockwise);
      RC_ASSERT((sign > 0.0) == (angle < std::numbers::pi));
      RC_ASSERT(check_centre(start, end, *centre, {}).has_value());
    }
  }));
}

// rs274 takes R short of half the chord by up to 0.00127 mm for a half circle about the middle.
TEST(ArcByRadius, ShortOfTheChordWithinTheToleranceIsAHalfCircle) {
  const PlanePoint end{.first = 20.0, .second = 0.0};
  for (const double radius : {10.0, 9.9999, 9.99874, -9.99874}) {
    const auto centre = centre_from_radius(kOrigin, end, radius, true, {});
    ASSERT_TRUE(centre) << radius;
    EXPECT_DOUBLE_EQ(centre->first, 10.0);
    EXPECT_DOUBLE_EQ(centre->second, 0.0);
  }
  EXPECT_EQ(centre_from_radius(kOrigin, end, 9.99872, true, {}).error(),
            ArcFault::radius_too_small);
}

TEST(ArcByRadius, NeedsAChord) {
  EXPECT_EQ(centre_from_radius(kOrigin, kOrigin, 5.0, false, {}).error(), ArcFault::no_chord);
}

TEST(ArcByCentre, MustBeSomewhereElseThanItsEnds) {
  const PlanePoint at{.first = 10.0, .second = 0.0};
  EXPECT_EQ(check_centre(at, at, at, {}).error(), ArcFault::zero_radius);
  EXPECT_EQ(check_centre(at, kOrigin, at, {}).error(), ArcFault::zero_radius);
  EXPECT_EQ(check_centre(kOrigin, at, at, {}).error(), ArcFault::zero_radius);
  EXPECT_TRUE(check_centre(at, at, {.first = 10.0013, .second = 0.0}, {}));
}

/// An arc from (radius, 0) to (0, radius + miss) about the origin.
bool closes(double radius_mm, double miss_mm, const ArcTolerance& tolerance) {
  return check_centre({.first = radius_mm, .second = 0.0},
                      {.first = 0.0, .second = radius_mm + miss_mm}, kOrigin, tolerance)
      .has_value();
}

// README, found by bisection with rs274: refused over 2.83 mm, or over 0.02828 mm and 0.1 % of the
// radius. Each bound from both sides.
TEST(ArcByCentre, ClosesWithinLinuxcncsBounds) {
  const ArcTolerance metric = arc_tolerance(false);
  EXPECT_TRUE(closes(10.0, 0.02828, metric));  // the absolute bound: 0.1 % is only 0.01
  EXPECT_FALSE(closes(10.0, 0.02829, metric));
  EXPECT_TRUE(closes(100.0, 0.10005, metric));  // 0.1 % of the larger radius, 100.10005
  EXPECT_FALSE(closes(100.0, 0.1002, metric));
  EXPECT_TRUE(closes(5000.0, 2.828, metric));  // 0.1 % would be 5
  EXPECT_FALSE(closes(5000.0, 2.829, metric));
  // The sign of the miss does not matter.
  EXPECT_FALSE(closes(10.0, -0.02829, metric));
  EXPECT_TRUE(closes(10.0, -0.02828, metric));
}

// 0.00282842712 in, 0.282842712 in and 0.00005 in; an inch is 25.4 mm.
TEST(ArcByCentre, HasBoundsOfItsOwnInInches) {
  const ArcTolerance inch = arc_tolerance(true);
  EXPECT_TRUE(closes(25.4, 0.002828 * 25.4, inch));
  EXPECT_FALSE(closes(25.4, 0.002829 * 25.4, inch));
  EXPECT_TRUE(closes(25'400.0, 0.2828 * 25.4, inch));
  EXPECT_FALSE(closes(25'400.0, 0.2829 * 25.4, inch));
  EXPECT_DOUBLE_EQ(inch.radius_mm, 0.00127);
}

}  // namespace
}  // namespace steadyrest::nc::interpret
