// SPDX-License-Identifier: Apache-2.0
// Speeds and feeds of a line that stays, its arcs and its splines.
#include <string>
#include <vector>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <steadyrest/nc/rewrite/tube/same_line.hpp>
#include <steadyrest/nc/rewrite/tube/test/made_moves.hpp>

namespace steadyrest::nc::rewrite {
namespace {

using interpret::Move;
using test::made_arc;
using test::made_line;
using ::testing::HasSubstr;

constexpr Permitted kSameFeeds{.feeds = true};
constexpr Permitted kSameSpeeds{.speeds = true};

std::string speed_difference(const Move& original, const Move& changed,
                             const Permitted& permitted = kSameSpeeds) {
  return line_difference(
      {.original = {&original, 1}, .changed = {&changed, 1}, .rounding_mm = 5e-4}, permitted);
}

/// SINUMERIK G4 S: so many turns at this speed.
Move dwell_of_turns(double turns, double spindle_rev_s) {
  Move move;
  move.kind = interpret::MoveKind::dwell;
  move.spindle_rev_s = spindle_rev_s;
  move.dwell_s = turns / spindle_rev_s;
  return move;
}

TEST(SameValues, TenTurnsAreTenTurnsAtAnotherSpeed) {
  EXPECT_EQ(speed_difference(dwell_of_turns(10, 50), dwell_of_turns(10, 55)), "");
  EXPECT_EQ(speed_difference(dwell_of_turns(10, 50), dwell_of_turns(11, 55)), "") << "0.2 s each";
  EXPECT_THAT(speed_difference(dwell_of_turns(10, 50), dwell_of_turns(9, 55)), HasSubstr("dwell"));
  EXPECT_THAT(speed_difference(dwell_of_turns(10, 50), dwell_of_turns(10, 55), kSameFeeds),
              HasSubstr("the spindle turns at 3300 rpm in place of 3000"));
}

// A block that may be replaced takes a lower feed over; a probe, what no override acts on and what
// must stay do not.
TEST(SameValues, OnlyACutTakesALowerFeed) {
  const auto speed_difference = [](const Move& a, const Move& b, const Permitted& permitted,
                                   bool replaceable = true) {
    return line_difference({.original = {&a, 1}, .changed = {&b, 1}, .replaceable = replaceable},
                           permitted);
  };
  Move original = made_line({0, 0, 0}, {9, 0, 0}, 10.0);
  Move slower = made_line({0, 0, 0}, {9, 0, 0}, 5.0);
  EXPECT_EQ(speed_difference(original, slower, kSameFeeds), "");
  EXPECT_NE(speed_difference(original, slower, kSameFeeds, false), "");
  EXPECT_THAT(speed_difference(slower, original, kSameFeeds),
              HasSubstr("runs at 600 mm/min in place of 300 mm/min"));
  EXPECT_NE(speed_difference(original, slower, kSameSpeeds), "");
  original.override_locked = slower.override_locked = true;
  EXPECT_NE(speed_difference(original, slower, kSameFeeds), "");
  original.override_locked = slower.override_locked = false;
  original.kind = slower.kind = interpret::MoveKind::probe;
  EXPECT_NE(speed_difference(original, slower, kSameFeeds), "");
}

TEST(SameValues, AnArcIsMovedByItsStartOrItsCentre) {
  const Move arc = made_arc({0, 0, 0}, {10, 0, 0}, {5, 0, 0}, 1);
  Move other = arc;
  EXPECT_FALSE(is_moved_arc(arc, other));
  other.start[1] = 1e-6;
  EXPECT_TRUE(is_moved_arc(arc, other));
  other = arc;
  other.centre_mm[0] += 1e-6;
  EXPECT_TRUE(is_moved_arc(arc, other));
  EXPECT_FALSE(is_moved_arc(made_line({0, 0, 0}, {1, 0, 0}), made_line({0, 1, 0}, {1, 0, 0})));
}

TEST(SameValues, ASplineHasItsControlPoints) {
  const std::vector<interpret::SplinePoint> points = {{0, 0, 1}, {1, 2, 1}, {3, 0, 1}};
  auto others = points;
  Move original = made_line({0, 0, 0}, {3, 0, 0});
  original.kind = interpret::MoveKind::spline;
  original.spline = points;
  Move changed = original;
  changed.spline = others;
  others[1].x_mm += 4e-4;
  EXPECT_EQ(speed_difference(original, changed), "");
  others[1].x_mm += 4e-4;
  EXPECT_THAT(speed_difference(original, changed), HasSubstr("control points"));
  others = points;
  others[2].weight = 1.1;
  EXPECT_THAT(speed_difference(original, changed), HasSubstr("control points"));
}

}  // namespace
}  // namespace steadyrest::nc::rewrite
