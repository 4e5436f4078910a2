// SPDX-License-Identifier: Apache-2.0
#include <cmath>
#include <numbers>

#include <gtest/gtest.h>

#include <steadyrest/contour/offline/predistort/polish/corner_legs.hpp>
#include <steadyrest/contour/offline/predistort/polish/test/mill.hpp>

namespace steadyrest::contour::offline {
namespace {

using kernel::signal::Point;

constexpr double kPlunge_mm_s = 10.0;

/// Down to the floor and away on it.
std::vector<Piece> plunge() {
  std::vector<Piece> out(2);
  out[0].segment = line_segment({0.0, 0.0, 10.0}, {0.0, 0.0, 0.0});
  out[1].segment = line_segment({0.0, 0.0, 0.0}, {20.0, 0.0, 0.0});
  out[0].segment.line = 1;
  out[1].segment.line = 2;
  for (Piece& piece : out) {
    piece.segment.feed_mm_s = kPlunge_mm_s;
    piece.segment.motion = kernel::signal::Motion::feed;
  }
  out[0].begins_run = true;
  out[0].progress_end_mm = out[1].progress_start_mm = 10.0;
  out[1].progress_end_mm = 30.0;
  return out;
}

/// What the way down leaves at the corner when the command goes `beyond_mm` on and back: the exact
/// answer of ẋ = k·(c − x), with ramps that take no time.
double left_mm(double beyond_mm) {
  const double lag = kPlunge_mm_s / kMillGain_1_s;
  return lag * (2.0 * std::exp(-kMillGain_1_s * beyond_mm / kPlunge_mm_s) - 1.0);
}

BlockStart at_corner(double behind_mm) {
  BlockStart out;
  out.progress_mm = 9.99;
  out.next_error_mm = {0.1, 0.0, -behind_mm};  // X begins to lag: that is along its own way
  return out;
}

CornerLegs legs() {
  return CornerLegs({.limit_mm = 0.01, .lag_s = 1.0 / kMillGain_1_s, .most_mm = 2.0});
}

TEST(CornerLegs, OnTheLineOutAndBackAndExactlyThere) {
  CornerLegs to(legs());
  const auto pieces = plunge();
  ASSERT_TRUE(to.update(pieces, std::vector{at_corner(kPlunge_mm_s / kMillGain_1_s)}));
  const auto made = to.with_legs(pieces);
  ASSERT_EQ(made.size(), 3U);
  const double beyond = kPlunge_mm_s * std::numbers::ln2 / kMillGain_1_s;
  EXPECT_NEAR(made[0].segment.end_mm[2], -beyond, 1e-12);
  EXPECT_EQ(made[1].segment.start_mm, made[0].segment.end_mm);
  EXPECT_EQ(made[1].segment.end_mm, pieces[1].segment.start_mm);
  EXPECT_EQ(made[1].segment.line, 1U);
  EXPECT_FALSE(made[1].joined);
  EXPECT_EQ(made[1].progress_start_mm, made[1].progress_end_mm);
  // ln 2 is right for ramps that take no time.
  EXPECT_NEAR(left_mm(beyond), 0.0, 1e-12);
  EXPECT_FALSE(to.update(pieces, std::vector{at_corner(left_mm(beyond))}));
}

TEST(CornerLegs, SecantsFindTheWayForAnyServo) {
  CornerLegs to(legs());
  const auto pieces = plunge();
  const auto servo = [](double beyond_mm) { return 1.3 * left_mm(1.15 * beyond_mm) + 0.004; };
  double beyond_mm = 0.0;
  int runs = 0;
  while (to.update(pieces, std::vector{at_corner(servo(beyond_mm))})) {
    beyond_mm = -to.with_legs(pieces)[0].segment.end_mm[2];
    ASSERT_LT(++runs, 8);
  }
  EXPECT_LT(std::abs(servo(beyond_mm)), 0.001);
}

TEST(CornerLegs, NotWhereNothingIsLeft) {
  CornerLegs to(legs());
  const auto pieces = plunge();
  EXPECT_FALSE(to.update(pieces, std::vector{at_corner(0.009)}));
  EXPECT_EQ(to.with_legs(pieces).size(), 2U);
  auto smooth = pieces;
  smooth[1].joined = true;
  EXPECT_FALSE(to.update(smooth, std::vector{at_corner(0.5)}));
  auto passed = pieces;
  passed[1].passes = true;
  EXPECT_FALSE(to.update(passed, std::vector{at_corner(0.5)}));
}

TEST(CornerLegs, NotFartherThanTheCommandMayGo) {
  CornerLegs to({.limit_mm = 0.01, .lag_s = 1.0 / kMillGain_1_s, .most_mm = 0.3});
  EXPECT_FALSE(to.update(plunge(), std::vector{at_corner(0.5)}));
}

}  // namespace
}  // namespace steadyrest::contour::offline
