// SPDX-License-Identifier: Apache-2.0
// Against closed forms: what belongs to what is known where one path is made from the other.
#include <algorithm>
#include <cmath>
#include <initializer_list>
#include <numbers>
#include <vector>

#include <gtest/gtest.h>
#include <rapidcheck/gtest.h>

#include <steadyrest/math/geometry/path_pairing.hpp>
#include <steadyrest/math/geometry/segment.hpp>
#include <steadyrest/math/geometry/test/segments.hpp>
#include <steadyrest/math/geometry/vector.hpp>

namespace steadyrest::math::geometry {
namespace {

using kernel::signal::Motion;
using kernel::signal::PathSegment;
using Path = std::vector<PathSegment>;

constexpr double kPi = std::numbers::pi;
constexpr double kStep_mm = 0.1;  ///< of the default configuration

Path joined(std::vector<PathSegment> segments) {
  double at_mm = 0.0;
  std::uint32_t line = 1;
  for (PathSegment& segment : segments) {
    segment.position_mm = at_mm;
    segment.line = line++;
    at_mm += segment.length_mm;
  }
  return segments;
}

Path lines(std::initializer_list<Point> points) {
  std::vector<PathSegment> out;
  for (const Point* p = points.begin(); p + 1 != points.end(); ++p) {
    out.push_back(test::line(*p, *(p + 1)));
  }
  return joined(std::move(out));
}

Path moved(Path path, const Point& by) {
  for (PathSegment& segment : path) {
    segment.start_mm = add(segment.start_mm, by);
    segment.end_mm = add(segment.end_mm, by);
    segment.centre_mm = add(segment.centre_mm, by);
  }
  return path;
}

double length_of(const Path& path) {
  return path.back().position_mm + path.back().length_mm;
}

PathPairing paired(const Path& changed, const Path& original, double tube_mm = 1.0) {
  const auto pairing = PathPairing::make(changed, original, {.tube_mm = tube_mm});
  EXPECT_TRUE(pairing.has_value());
  return pairing.value();
}

/// The largest deviation of the place from `expected(s)` over the whole changed path.
template <class Expected>
double deviation(const PathPairing& pairing, const Path& changed, Expected expected) {
  double most = 0.0;
  double last = 0.0;
  for (double s = 0.0; s <= length_of(changed); s += 0.037) {
    const double at = pairing.original_mm(s);
    EXPECT_GE(at, last) << "backwards at " << s;
    last = at;
    most = std::max(most, std::abs(at - expected(s)));
  }
  return most;
}

/// A pocket from the outside in: every pass comes back to places that others have cut.
Path spiral_pocket() {
  return joined({test::line({0, 0, 5}, {0, 0, 0}),
                 test::arc({0, 0, 0}, {0, 0, 1}, 8.0, 1.0, 0.0, 14.0 * kPi, 0.0)});
}

// A figure of eight; a line there and back, twice; three turns of a circle; a helix of 0.2 mm rise.
std::vector<Path> paths_that_come_back() {
  return {lines({{0, 0, 0}, {20, 20, 0}, {20, 0, 0}, {0, 20, 0}, {0, 0, 0}}),
          lines({{0, 0, 0}, {15, 0, 0}, {0, 0, 0}, {15, 0, 0}, {0, 0, 0}}),
          joined({test::arc({0, 0, 0}, {0, 0, 1}, 3.0, 3.0, 0.0, 6.0 * kPi, 0.0)}),
          joined({test::arc({0, 0, 0}, {0, 0, -1}, 4.0, 4.0, 0.0, 10.0 * kPi, 1.0)}),
          spiral_pocket()};
}

TEST(PathPairing, OfAPathWithItselfIsEveryPlaceItself) {
  for (const Path& path : paths_that_come_back()) {
    const PathPairing pairing = paired(path, path);
    EXPECT_LT(deviation(pairing, path, [](double s) { return s; }), 1e-9);
    EXPECT_EQ(pairing.slack_mm(), 0.0);
    EXPECT_LT(pairing.farthest().distance_mm, 1e-9);
  }
}

TEST(PathPairing, FollowsAShiftedPathThroughEveryReturn) {
  const Point by = {0.2, -0.1, 0.05};
  for (const Path& path : paths_that_come_back()) {
    const PathPairing pairing = paired(moved(path, by), path);
    EXPECT_LE(deviation(pairing, path, [](double s) { return s; }), norm(by) + 2.0 * kStep_mm);
    EXPECT_LE(pairing.farthest().distance_mm, norm(by) + 1e-9);
  }
}

TEST(PathPairing, OfAWiderCircleGoesByTheAngle) {
  const double wider_mm = 0.05;
  const auto circle = [](double radius) {
    return joined({test::arc({1, 2, 3}, {0, 0, 1}, radius, radius, 0.3, 6.0 * kPi, 0.0)});
  };
  const Path changed = circle(5.0 + wider_mm);
  const PathPairing pairing = paired(changed, circle(5.0));
  EXPECT_LE(deviation(pairing, changed, [](double s) { return s * 5.0 / 5.05; }), kStep_mm);
  EXPECT_NEAR(pairing.farthest().distance_mm, wider_mm, 1e-9);
}

// On the middle of the fillet the distance to either leg is r(1 − 1/√2); the corner itself is
// r(√2 − 1) away from the fillet, which the tube must bear.
TEST(PathPairing, RoundsACornerWithinTheTubeAndRefusesOneBeyond) {
  const Path corner = lines({{0, 0, 0}, {20, 0, 0}, {20, 20, 0}});
  const auto fillet = [](double r) {
    return joined({test::line({0, 0, 0}, {20 - r, 0, 0}),
                   test::arc({20 - r, r, 0}, {0, 0, 1}, r, r, -0.5 * kPi, 0.5 * kPi, 0.0),
                   test::line({20, r, 0}, {20, 20, 0})});
  };
  const PathPairing pairing = paired(fillet(2.0), corner);
  // The stations are up to half a step off the middle.
  EXPECT_LE(pairing.farthest().distance_mm, 2.0 * (1.0 - std::sqrt(0.5)) + 1e-9);
  EXPECT_GE(pairing.farthest().distance_mm, 2.0 * (1.0 - std::sqrt(0.5)) - 0.5 * kStep_mm);
  EXPECT_NEAR(pairing.slack_mm(), 2.0 * (std::sqrt(2.0) - 1.0), kStep_mm);
  EXPECT_NEAR(pairing.original_mm(length_of(fillet(2.0))), 40.0, 1e-9);
  const auto parted = PathPairing::make(fillet(3.0), corner, {.tube_mm = 1.0});
  ASSERT_FALSE(parted.has_value());
  EXPECT_EQ(parted.error().original_segment, 0U) << "the corner's first leg";
}

// 0.6 mm past the corner and back, as a corrected path does.
TEST(PathPairing, StaysAtTheCornerWhileThePathOvershootsIt) {
  const Path corner = lines({{0, 0, 0}, {20, 0, 0}, {20, 20, 0}});
  const Path over = lines({{0, 0, 0}, {20.6, 0, 0}, {20, 0, 0}, {20, 20, 0}});
  const PathPairing pairing = paired(over, corner);
  EXPECT_LE(std::abs(pairing.original_mm(20.6) - 20.0), 0.6);
  EXPECT_NEAR(pairing.original_mm(31.2), 30.0, kStep_mm);
  EXPECT_NEAR(pairing.farthest().distance_mm, 0.6, 1e-9);
}

// Both ways round the tube: the changed path leaves out a side step, or makes one of its own.
TEST(PathPairing, NamesThePlaceWhereThePathsPart) {
  const Path straight = lines({{0, 0, 0}, {10, 0, 0}, {30, 0, 0}});
  const Path stepped =
      lines({{0, 0, 0}, {10, 0, 0}, {10, 8, 0}, {10, 0, 0}, {20, 0, 0}, {30, 0, 0}});
  const auto left_out = PathPairing::make(straight, stepped, {});
  ASSERT_FALSE(left_out.has_value());
  EXPECT_EQ(left_out.error().changed_segment, 1U);
  EXPECT_EQ(left_out.error().original_segment, 1U);
  EXPECT_NEAR(left_out.error().distance_mm, 1.0, 2.0 * kStep_mm);
  const auto added = PathPairing::make(stepped, straight, {});
  ASSERT_FALSE(added.has_value());
  EXPECT_EQ(added.error().changed_segment, 1U);
  EXPECT_NEAR(added.error().distance_mm, 1.0, 2.0 * kStep_mm);
  const auto shorter = PathPairing::make(lines({{0, 0, 0}, {10, 0, 0}}), straight, {});
  ASSERT_FALSE(shorter.has_value());
  EXPECT_TRUE(shorter.error().ended);
  EXPECT_EQ(shorter.error().original_segment, 1U);
  const auto elsewhere = PathPairing::make(moved(straight, {0, 5, 0}), straight, {});
  ASSERT_FALSE(elsewhere.has_value());
  EXPECT_EQ(elsewhere.error().distance_mm, 5.0);
}

// Two cuts with a rapid between them: 40 mm high on one side, 2 mm on the other.
TEST(PathPairing, LeavesTheWayBetweenTwoCutsFree) {
  const auto part = [](double height) {
    Path path =
        lines({{0, 0, 0}, {10, 0, 0}, {10, 0, height}, {10, 10, height}, {10, 10, 0}, {0, 10, 0}});
    for (const std::size_t i : {1U, 2U, 3U}) {
      path[i].motion = Motion::rapid;
    }
    return path;
  };
  const Path changed = part(40.0);
  const PathPairing pairing = paired(changed, part(2.0));
  EXPECT_NEAR(pairing.original_mm(4.0), 4.0, 1e-9);
  EXPECT_NEAR(pairing.original_mm(100.0 + 4.0), 24.0 + 4.0, 1e-9) << "in the second cut";
  Path one_cut = part(2.0);
  one_cut[1].motion = one_cut[2].motion = one_cut[3].motion = Motion::feed;
  EXPECT_FALSE(PathPairing::make(changed, one_cut, {}).has_value()) << "then the way counts";
}

// The tube is the largest distance at which it follows, from both sides. The turns lie 1 mm apart.
RC_GTEST_PROP(PathPairing, FollowsAnyShiftWithinTheTubeAndNoneBeyond, ()) {
  const double tube_mm = *test::number(0.2, 0.95);
  const Point by = scale(unit(add(*test::point(1.0), Point{0, 0, 1e-3})), tube_mm);
  const Path path = spiral_pocket();
  RC_ASSERT(
      PathPairing::make(moved(path, scale(by, 0.999)), path, {.tube_mm = tube_mm}).has_value());
  RC_ASSERT(!PathPairing::make(moved(path, {0, 0, 1.001 * tube_mm}), path, {.tube_mm = tube_mm})
                 .has_value());
}

TEST(PathPairing, DistanceToAPieceOfPathIsThatToItsNearestPoint) {
  const Path path = lines({{0, 0, 0}, {10, 0, 0}, {10, 10, 0}});
  EXPECT_EQ(distance_to(path, {4, 3, 0}, 0.0, 20.0), 3.0);
  EXPECT_EQ(distance_to(path, {4, 3, 0}, 8.0, 20.0), 5.0);
  EXPECT_EQ(segment_at(path, 9.9), 0U);
  EXPECT_EQ(segment_at(path, 10.1), 1U);
  EXPECT_EQ(segment_at(path, 25.0), 1U);
}

}  // namespace
}  // namespace steadyrest::math::geometry
