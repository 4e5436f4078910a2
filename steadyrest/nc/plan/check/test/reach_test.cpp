// SPDX-License-Identifier: Apache-2.0
// How far a move reaches, checked against a thousand points along each arc.
#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>

#include <gtest/gtest.h>
#include <rapidcheck.h>
#include <rapidcheck/gtest.h>

#include <steadyrest/nc/plan/check/reach.hpp>

namespace steadyrest::nc::plan {
namespace {

using interpret::Axes;
using interpret::Move;
using interpret::MoveKind;

constexpr int kPoints = 1000;
constexpr double kWholeTurn = 2.0 * std::numbers::pi;

/// An arc by its angles: from `from_rad` on by `sweep_rad`, signed as `turns` is.
struct ArcByAngles {
  std::size_t normal = 2;
  double from_rad = 0.0;
  double sweep_rad = 1.0;
  double radius_mm = 10.0;
  double radius_end_mm = 10.0;
  double rise_mm = 0.0;
};

Axes point_of(const Move& move, const ArcByAngles& arc, double u) {
  const std::size_t first = (arc.normal + 1) % 3;
  const std::size_t second = (arc.normal + 2) % 3;
  const double radius = arc.radius_mm + u * (arc.radius_end_mm - arc.radius_mm);
  const double angle = arc.from_rad + u * arc.sweep_rad;
  Axes at{};
  at[first] = move.centre_mm[first] + radius * std::cos(angle);
  at[second] = move.centre_mm[second] + radius * std::sin(angle);
  at[arc.normal] = move.centre_mm[arc.normal] + u * arc.rise_mm;
  return at;
}

Move move_of(const ArcByAngles& arc, const std::array<double, 3>& centre_mm, double rotation_deg) {
  Move move;
  move.kind = MoveKind::arc;
  move.centre_mm = centre_mm;
  move.normal[arc.normal] = 1.0;
  move.rotation_deg = rotation_deg;
  move.offset = {100.0, -50.0, 7.0};
  const int begun = static_cast<int>(std::ceil(std::abs(arc.sweep_rad) / kWholeTurn - 1e-9));
  move.turns = arc.sweep_rad < 0.0 ? -begun : begun;
  move.start = point_of(move, arc, 0.0);
  move.end = point_of(move, arc, 1.0);
  return move;
}

Reach sampled(const Move& move, const ArcByAngles& arc, std::size_t axis) {
  Reach out{.low_mm = 1e9, .high_mm = -1e9};
  for (int i = 0; i <= kPoints; ++i) {
    const double at = machine_of(move, point_of(move, arc, static_cast<double>(i) / kPoints))[axis];
    out.low_mm = std::min(out.low_mm, at);
    out.high_mm = std::max(out.high_mm, at);
  }
  return out;
}

double tenths(int low, int high) {
  return *rc::gen::inRange(10 * low, 10 * high) / 10.0;
}

ArcByAngles any_arc() {
  ArcByAngles arc;
  arc.normal = *rc::gen::inRange<std::size_t>(0, 3);
  arc.from_rad = tenths(-4, 4) + 0.013;
  arc.sweep_rad = (*rc::gen::arbitrary<bool>() ? 1.0 : -1.0) * (tenths(0, 14) + 0.1);
  arc.radius_mm = arc.radius_end_mm = tenths(1, 40);
  return arc;
}

// With 1000 points, one is always within 0.007 rad of an extreme: at most r·0.007²/2 is lost.
RC_GTEST_PROP(Reach, OfACircleIsThatOfItsPointsInEveryPlaneAndRotation, ()) {
  const ArcByAngles arc = any_arc();
  const Move move =
      move_of(arc, {tenths(-20, 20), tenths(-20, 20), tenths(-20, 20)}, tenths(-180, 180));
  for (std::size_t axis = 0; axis < 3; ++axis) {
    const Reach reach = reach_of(move, axis);
    const Reach truth = sampled(move, arc, axis);
    RC_ASSERT(reach.low_mm <= truth.low_mm + 1e-9);
    RC_ASSERT(reach.high_mm >= truth.high_mm - 1e-9);
    RC_ASSERT(reach.low_mm >= truth.low_mm - 3e-5 * arc.radius_mm);
    RC_ASSERT(reach.high_mm <= truth.high_mm + 3e-5 * arc.radius_mm);
  }
}

// The bound of a spiral or helix uses its larger radius and its whole rise: it contains every point
// and is off by at most the change of radius and height.
RC_GTEST_PROP(Reach, OfASpiralOrHelixHoldsAllItsPoints, ()) {
  ArcByAngles arc = any_arc();
  arc.radius_end_mm = tenths(1, 40);
  arc.rise_mm = tenths(-15, 15);
  const Move move = move_of(arc, {1.0, 2.0, 3.0}, tenths(-180, 180));
  const double change_mm = std::abs(arc.radius_end_mm - arc.radius_mm) + std::abs(arc.rise_mm);
  for (std::size_t axis = 0; axis < 3; ++axis) {
    const Reach reach = reach_of(move, axis);
    const Reach truth = sampled(move, arc, axis);
    RC_ASSERT(reach.low_mm <= truth.low_mm + 1e-9);
    RC_ASSERT(reach.high_mm >= truth.high_mm - 1e-9);
    RC_ASSERT(reach.low_mm >= truth.low_mm - change_mm - 2e-3);
    RC_ASSERT(reach.high_mm <= truth.high_mm + change_mm + 2e-3);
  }
}

// A quarter from 3 to 12 o'clock passes no other extreme; the same ends clockwise pass three.
TEST(Reach, OfAQuarterKnowsWhichWayRound) {
  ArcByAngles arc{.sweep_rad = std::numbers::pi / 2};
  const Move quarter = move_of(arc, {0, 0, 0}, 0.0);
  EXPECT_NEAR(reach_of(quarter, 0).low_mm, 100.0, 1e-9);
  EXPECT_NEAR(reach_of(quarter, 1).low_mm, -50.0, 1e-9);
  arc.sweep_rad = -1.5 * std::numbers::pi;
  const Move rest = move_of(arc, {0, 0, 0}, 0.0);
  EXPECT_NEAR(reach_of(rest, 0).low_mm, 90.0, 1e-9);
  EXPECT_NEAR(reach_of(rest, 1).low_mm, -60.0, 1e-9);
  EXPECT_NEAR(reach_of(rest, 1).high_mm, -40.0, 1e-9);
}

// Rotary axes and U V W belong to no plane: their ends suffice.
TEST(Reach, OfFurtherAxesIsThatOfTheirEnds) {
  Move move = move_of({.sweep_rad = 3.0}, {0, 0, 0}, 30.0);
  move.start[3] = 5.0;
  move.end[3] = -20.0;
  move.offset[3] = 1.0;
  EXPECT_NEAR(reach_of(move, 3).low_mm, -19.0, 1e-12);
  EXPECT_NEAR(reach_of(move, 3).high_mm, 6.0, 1e-12);
}

}  // namespace
}  // namespace steadyrest::nc::plan
