// SPDX-License-Identifier: Apache-2.0
#include <cmath>
#include <numbers>

#include <gtest/gtest.h>
#include <rapidcheck.h>

#include <steadyrest/nc/interpret/state/offset_corner.hpp>

namespace steadyrest::nc::interpret {
namespace {

constexpr double kHalfTurn = std::numbers::pi;
constexpr PlanePoint kAlongFirst{.first = 1.0, .second = 0.0};
constexpr PlanePoint kAlongSecond{.first = 0.0, .second = 1.0};

void expect_at(const std::optional<PlanePoint>& point, double first, double second) {
  ASSERT_TRUE(point);
  EXPECT_NEAR(point->first, first, 1e-12);
  EXPECT_NEAR(point->second, second, 1e-12);
}

// README: up to 0.05 rad the offset pieces count as meeting, and as near to a reversal.
TEST(OffsetCorner, IsTangentConvexOrConcaveByItsTurn) {
  EXPECT_EQ(kind_of(0.0499, false), Corner::tangent);
  EXPECT_EQ(kind_of(-0.0499, true), Corner::tangent);
  EXPECT_EQ(kind_of(0.0501, false), Corner::concave);
  EXPECT_EQ(kind_of(-0.0501, false), Corner::convex);
  EXPECT_EQ(kind_of(kHalfTurn - 0.0501, false), Corner::concave);
  EXPECT_EQ(kind_of(kHalfTurn - 0.0499, false), Corner::convex);
  EXPECT_EQ(kind_of(-kHalfTurn + 0.0501, true), Corner::convex);
  EXPECT_EQ(kind_of(-kHalfTurn + 0.0499, true), Corner::concave);
}

// A quarter to the left is towards a tool on the left (G41, −1).
TEST(OffsetCorner, TurnsTowardsTheToolOrAwayFromIt) {
  EXPECT_NEAR(turn_between(kAlongFirst, kAlongSecond, -1), 0.5 * kHalfTurn, 1e-15);
  EXPECT_NEAR(turn_between(kAlongFirst, kAlongSecond, 1), -0.5 * kHalfTurn, 1e-15);
  EXPECT_NEAR(turn_between(kAlongSecond, kAlongFirst, -1), -0.5 * kHalfTurn, 1e-15);
  EXPECT_EQ(turn_between(kAlongFirst, {.first = 3.0, .second = 0.0}, -1), 0.0);
}

// The 3-4-5 triangle: centre 2 above the line, tool radius 5, circle of 5 about the centre. The
// offset line is 3 above the centre and crosses 4 before and after it.
TEST(OffsetCorner, OfALineAndAnArcIsWhereTheOffsetLineEntersOrLeavesTheCircle) {
  const auto at = [](bool inside, bool leaving) {
    const OffsetCircle circle{
        .centre = {.first = 7.0, .second = 2.0}, .radius = 5.0, .tool_inside = inside};
    return crossing(circle, kAlongSecond, kAlongFirst, 2.0, 5.0, leaving);
  };
  expect_at(at(true, true), 3.0, 5.0);    // into the circle
  expect_at(at(true, false), 11.0, 5.0);  // as far as its other side
  expect_at(at(false, true), 11.0, 5.0);
  expect_at(at(false, false), 3.0, 5.0);
  const OffsetCircle small{.centre = {}, .radius = 2.9};
  EXPECT_FALSE(crossing(small, kAlongSecond, kAlongFirst, 2.0, 5.0, true));
}

// Radii 3 and 4, centres 5 apart: a right angle at the crossing, 1.8 along and 2.4 beside.
TEST(OffsetCorner, OfTwoArcsIsOnBothCircles) {
  OffsetCircle before{.centre = {}, .radius = 3.0, .tool_inside = true};
  OffsetCircle after{.centre = {.first = 5.0, .second = 0.0}, .radius = 4.0};
  after.counter_clockwise = true;
  expect_at(crossing(before, after), 1.8, 2.4);
  after.counter_clockwise = false;
  expect_at(crossing(before, after), 1.8, -2.4);
  before.tool_inside = false;
  expect_at(crossing(before, after), 1.8, 2.4);
  after.radius = 1.9;  // 3 + 1.9 does not reach
  EXPECT_FALSE(crossing(before, after));
  after.radius = 8.1;  // one within the other
  EXPECT_FALSE(crossing(before, after));
  after.centre = {};
  EXPECT_FALSE(crossing(before, after));
}

TEST(OffsetCorner, AnArcSweepsFromItsStartToItsEndInItsNumberOfTurns) {
  EXPECT_TRUE(rc::check([] {
    const double from = *rc::gen::inRange(-314, 315) / 100.0;
    const double sweep = *rc::gen::inRange(1, 628) / 100.0;
    const int turns = *rc::gen::inRange(1, 5) * (*rc::gen::arbitrary<bool>() ? 1 : -1);
    const double whole =
        (turns > 0 ? 1.0 : -1.0) * (sweep + 2.0 * kHalfTurn * (std::abs(turns) - 1));
    const PlanePoint centre{.first = 3.0, .second = -4.0};
    const auto at = [&](double angle) {
      return along(centre, {.first = std::cos(angle), .second = std::sin(angle)}, 10.0);
    };
    RC_ASSERT(std::abs(swept(at(from), at(from + whole), centre, turns) - whole) < 1e-9);
  }));
  EXPECT_EQ(swept(kAlongFirst, kAlongFirst, {}, 1), 2.0 * kHalfTurn);
  EXPECT_EQ(swept(kAlongFirst, kAlongFirst, {}, -2), -4.0 * kHalfTurn);
}

}  // namespace
}  // namespace steadyrest::nc::interpret
