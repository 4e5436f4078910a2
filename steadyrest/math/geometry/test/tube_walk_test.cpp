// SPDX-License-Identifier: Apache-2.0
// Against closed forms, and against the discrete Fréchet distance of dense points.
#include <algorithm>
#include <cmath>
#include <initializer_list>
#include <numbers>
#include <vector>

#include <gtest/gtest.h>
#include <rapidcheck/gtest.h>

#include <steadyrest/math/geometry/segment.hpp>
#include <steadyrest/math/geometry/test/segments.hpp>
#include <steadyrest/math/geometry/tube_walk.hpp>
#include <steadyrest/math/geometry/vector.hpp>

namespace steadyrest::math::geometry {
namespace {

ChordPath chords(std::initializer_list<Point> points) {
  return {points, std::vector<double>(points.size() - 1, 0.0)};
}

/// Turns about the origin from (radius, 0), growing by `growth` in all.
ChordPath turns(double radius_mm, double turns, double growth_mm = 0.0, double slack_mm = 1e-5) {
  ChordPath path{{{radius_mm, 0.0, 0.0}}, {}};
  path.add(test::arc({0, 0, 0}, {0, 0, 1}, radius_mm, radius_mm + growth_mm, 0.0,
                     2.0 * std::numbers::pi * turns, 0.0),
           slack_mm);
  return path;
}

TubeVerdict walk(const ChordPath& changed, const ChordPath& original, double tube_mm) {
  const std::vector<ChordRange> all(changed.size(),
                                    {0, static_cast<std::uint32_t>(original.size()) - 1});
  return walk_tube(changed, original, all, tube_mm);
}

TEST(TubeWalk, ACircleIsInsideFromTheDifferenceOfTheRadiiOn) {
  const ChordPath original = turns(10.0, 1.0);
  const ChordPath wider = turns(10.1, 1.0);
  EXPECT_TRUE(walk(wider, original, 0.1 + 3e-5).inside);
  EXPECT_FALSE(walk(wider, original, 0.1 - 1e-6).inside);
  EXPECT_NEAR(walk(wider, original, 0.2).farthest_mm, 0.1, 2e-5);
}

TEST(TubeWalk, AnotherTurnOfASpiralIsAnotherPath) {
  // Neighbouring turns are 0.3 mm apart: every point is near, but not in order.
  const ChordPath original = turns(10.0, 4.0, 1.2);
  EXPECT_TRUE(walk(turns(10.05, 4.0, 1.2), original, 0.4).inside);
  EXPECT_FALSE(walk(turns(10.0, 3.0, 0.9), original, 0.4).inside);
  EXPECT_FALSE(walk(turns(10.0, 5.0, 1.5), original, 0.4).inside);
}

TEST(TubeWalk, ACornerLeftOutIsNotInside) {
  const ChordPath corner = chords({{-5, 0, 0}, {0, 0, 0}, {0, -5, 0}});
  // The chord is 1/√2 from the corner's legs at most, √2 from the corner.
  const ChordPath cut = chords({{-5, 0, 0}, {-2, 0, 0}, {0, -2, 0}, {0, -5, 0}});
  EXPECT_FALSE(walk(cut, corner, 1.4).inside);
  EXPECT_TRUE(walk(cut, corner, 1.42).inside);
  EXPECT_NEAR(walk(cut, corner, 1.5).farthest_mm, std::sqrt(2.0), 1e-12);
}

TEST(TubeWalk, NeverTurnsBack) {
  const ChordPath straight = chords({{0, 0, 0}, {10, 0, 0}});
  // Back by 2 mm: both stay within 1 mm of the middle of the way back.
  const ChordPath back = chords({{0, 0, 0}, {6, 0, 0}, {4, 0, 0}, {10, 0, 0}});
  EXPECT_FALSE(walk(back, straight, 0.999).inside);
  EXPECT_TRUE(walk(back, straight, 1.001).inside);
  EXPECT_FALSE(walk(straight, back, 0.999).inside);
  EXPECT_TRUE(walk(straight, back, 1.001).inside);
}

TEST(TubeWalk, SaysHowFarItCame) {
  const ChordPath original = chords({{0, 0, 0}, {1, 0, 0}, {2, 0, 0}, {3, 0, 0}});
  const ChordPath out = chords({{0, 0, 0}, {1, 0, 0}, {2, 0.2, 0}, {3, 0, 0}});
  const TubeVerdict verdict = walk(out, original, 0.1);
  EXPECT_FALSE(verdict.inside);
  EXPECT_EQ(verdict.changed, 1U);
  EXPECT_EQ(verdict.original, 1U);
  // An end that is not reached is the last chord's fault.
  const TubeVerdict shortened = walk(chords({{0, 0, 0}, {2.5, 0, 0}}), original, 0.1);
  EXPECT_FALSE(shortened.inside);
  EXPECT_EQ(shortened.original, 2U);
}

TEST(TubeWalk, KeepsToThePermittedChords) {
  const ChordPath path = chords({{0, 0, 0}, {1, 0, 0}, {2, 0, 0}, {3, 0, 0}});
  const std::vector<ChordRange> own = {{0, 1}, {1, 2}, {2, 2}};
  EXPECT_TRUE(walk_tube(path, path, own, 0.1).inside);
  const ChordPath early = chords({{0, 0, 0}, {3, 0, 0}, {3, 0, 0}, {3, 0, 0}});
  EXPECT_TRUE(walk(early, path, 0.1).inside);
  EXPECT_FALSE(walk_tube(early, path, own, 0.1).inside);
}

using Points = std::vector<Point>;

Points dense(const ChordPath& path, double step_mm) {
  Points out = {path.points[0]};
  for (std::size_t i = 0; i < path.size(); ++i) {
    const Point& a = path.points[i];
    const Point way = subtract(path.points[i + 1], a);
    const double parts = std::max(1.0, std::ceil(norm(way) / step_mm));
    for (double k = 1.0; k <= parts; ++k) {
      out.push_back(add_scaled(a, way, k / parts));
    }
  }
  return out;
}

/// The largest step of the best walk through both rows of points.
double discrete_frechet(const Points& a, const Points& b) {
  std::vector<double> row(b.size());
  for (std::size_t i = 0; i < a.size(); ++i) {
    std::vector<double> next(b.size());
    for (std::size_t j = 0; j < b.size(); ++j) {
      double best = i == 0 && j == 0 ? 0.0 : 1e300;
      best = i > 0 ? std::min(best, row[j]) : best;
      best = j > 0 ? std::min(best, next[j - 1]) : best;
      best = i > 0 && j > 0 ? std::min(best, row[j - 1]) : best;
      next[j] = std::max(best, distance(a[i], b[j]));
    }
    row = next;
  }
  return row.back();
}

// The distance of dense points is the paths' own to less than their step.
RC_GTEST_PROP(TubeWalk, AgreesWithTheDistanceOfDensePoints, ()) {
  constexpr double kDense_mm = 0.05;
  const auto number = [] { return 0.01 * *rc::gen::inRange(-100, 100); };
  ChordPath original{{{0, 0, 0}}, {}};
  ChordPath changed{{{0, 0, 0}}, {}};
  double along = 0.0;
  const int corners = *rc::gen::inRange(1, 8);
  for (int i = 0; i < corners; ++i) {
    along += 0.5 * number();
    original.points.push_back({along, number(), 0.3 * number()});
    original.slack_mm.push_back(0.0);
  }
  for (const Point& point : original.points) {
    const int near = *rc::gen::inRange(0, 3);
    for (int k = 0; k < near; ++k) {
      changed.points.push_back(add(point, {0.3 * number(), 0.3 * number(), 0.1 * number()}));
      changed.slack_mm.push_back(0.0);
    }
  }
  changed.points.push_back(original.points.back());
  changed.slack_mm.push_back(0.0);
  const double truth = discrete_frechet(dense(changed, kDense_mm), dense(original, kDense_mm));
  RC_ASSERT(walk(changed, original, truth + 1e-9).inside);
  RC_ASSERT(!walk(changed, original, truth - kDense_mm).inside);
  RC_ASSERT(walk(changed, original, truth + 1e-9).farthest_mm <= truth + 1e-9);
}

// What an arc's chords call inside is inside, however few they are.
RC_GTEST_PROP(TubeWalk, TheSlackOfChordsIsOnTheSafeSide, ()) {
  const double radius = 0.1 * *rc::gen::inRange(5, 200);
  const double growth = 0.01 * *rc::gen::inRange(-40, 40);
  const double sweep = 0.05 * *rc::gen::inRange(1, 200);
  const double slack = *rc::gen::element(0.3, 0.05, 0.001);
  const auto arc = test::arc({0, 0, 0}, {0, 0, 1}, radius, radius + growth, 0.0, sweep, 0.2);
  ChordPath path{{arc.start_mm}, {}};
  path.add(arc, slack);
  const auto chords = static_cast<double>(path.size());
  for (double u = 0.0; u < 1.0; u += 0.003) {
    const auto i = static_cast<std::size_t>(u * chords);
    const double share = u * chords - static_cast<double>(i);
    const Point on_chord =
        add_scaled(path.points[i], subtract(path.points[i + 1], path.points[i]), share);
    RC_ASSERT(distance(on_chord, point_at(arc, u)) <= path.slack_mm[i] + 1e-12);
    RC_ASSERT(path.slack_mm[i] <= slack + 1e-9);
  }
}

}  // namespace
}  // namespace steadyrest::math::geometry
