// SPDX-License-Identifier: Apache-2.0
#include <cmath>
#include <limits>

#include <gtest/gtest.h>
#include <rapidcheck/gtest.h>

#include <steadyrest/contour/online/contour_error.hpp>
#include <steadyrest/contour/online/test/path_runner.hpp>
#include <steadyrest/contour/online/test/paths.hpp>
#include <steadyrest/math/geometry/foot_point.hpp>
#include <steadyrest/math/geometry/test/segments.hpp>
#include <steadyrest/math/geometry/vector.hpp>

namespace steadyrest::contour::online {
namespace {

namespace geometry = math::geometry;
using kernel::signal::PathView;
using test::estimator;
using test::kTurn;
using test::PathMaker;
using test::PathSegment;
using test::Runner;

/// The nearest point of all segments within the range that the lag permits. The oracle: no search
/// order, no skipping, every segment in the window by the geometry's own foot point. It shares the
/// window with the room, which the spiral and slot tests check separately.
double nearest_of_all(PathView path, const ContourError::Input& input, double gain_1_s) {
  const double e = geometry::distance(input.command_mm, input.actual_mm);
  const double end = input.path_position_mm + 0.25 * e + 0.25;
  const double begin =
      input.path_position_mm - 0.25 - std::max(2.5 * input.path_speed_mm_s / gain_1_s, 1.2 * e);
  double best = std::numeric_limits<double>::infinity();
  for (const PathSegment& segment : path) {
    const double low = begin - segment.position_mm;
    const double high = end - segment.position_mm;
    if (high > 0.0 && low < segment.length_mm) {
      const double u_low = geometry::parameter_at(segment, low);
      const double u_high = geometry::parameter_at(segment, high);
      best = std::min(
          best, geometry::foot_point(segment, input.actual_mm, u_low, u_high, u_low).distance_mm);
    }
  }
  return best;
}

// Left of +X is +Y with the normal +Z. A sign that followed the curvature here would be 0/0.
TEST(ContourError, OnALineIsPositiveToTheLeft) {
  const auto path = PathMaker({0, 0, 0}, 50.0).line_to({100, 0, 0}).path();
  ContourError error = estimator();
  EXPECT_NEAR(error.update({0.0, {50, 0, 0}, {49, 0.02, 0}, path, 0, 50.0, 50.0}).error_mm, 0.02,
              1e-12);
  EXPECT_NEAR(error.update({0.01, {50, 0, 0}, {49, -0.02, 0}, path, 0, 50.0, 50.0}).error_mm, -0.02,
              1e-12);
}

// 0.03 and 0.04 from the corner make 0.05: the distance to the corner, not to the line of either
// leg.
TEST(ContourError, OutsideOfACornerIsMeasuredToTheCorner) {
  const auto path = PathMaker({0, 0, 0}, 50.0).line_to({10, 0, 0}).line_to({10, 10, 0}).path();
  ContourError error = estimator();
  const auto output = error.update({0.0, {10, 0.4, 0}, {10.03, -0.04, 0}, path, 1, 10.4, 50.0});
  EXPECT_NEAR(output.error_mm, -0.05, 1e-12);  // right of the travel: outside of a left turn
  EXPECT_NEAR(output.foot_position_mm, 10.0, 1e-12);
}

// A rapid along X, a cut along Y. The tool lags by a millimetre: when the cut begins it is still on
// the rapid, whose error does not end up in the part.
TEST(ContourError, IsThePartsOnlyWhereCommandAndToolAreInTheCut) {
  const auto path = PathMaker({0, 0, 0}, 50.0).line_to({10, 0, 0}).line_to({10, 10, 0}).path();
  for (const PathView shown : {PathView(path), PathView()}) {
    ContourError error = estimator();
    double time_s = 0.0;
    for (double s = 0.0; s < 20.0; s += 0.1, time_s += 0.002) {
      const auto at = [](double way) {
        return kernel::signal::Point{std::min(way, 10.0), std::max(0.0, way - 10.0), 0.0};
      };
      const bool cuts = s > 10.01;
      const auto output = error.update({.time_s = time_s,
                                        .command_mm = at(s),
                                        .actual_mm = at(std::max(0.0, s - 1.0)),
                                        .path = shown,
                                        .path_index = cuts ? 1U : 0U,
                                        .path_position_mm = s,
                                        .path_speed_mm_s = 50.0,
                                        .in_cut = cuts});
      if (output.valid) {
        EXPECT_EQ(output.in_cut, s - 1.0 > 10.05) << s;
      }
    }
    // The same program again: its first cut is not compared with the end of the last.
    EXPECT_TRUE(error.update({time_s, {5, 0, 0}, {5, 0, 0}, path, 0, 5.0, 50.0}).in_cut);
  }
}

/// The rapid and the cut of above; whether the error is the part's with the tool at `tool_mm`.
struct RapidThenCut {
  RapidThenCut() {
    path = PathMaker({0, 0, 0}, 50.0).line_to({10, 0, 0}).line_to({10, 10, 0}).path();
    path[0].motion = kernel::signal::Motion::rapid;
  }
  bool in_cut(double place_mm, double tool_mm, bool cuts, bool shown) {
    const auto at = [](double way) {
      return kernel::signal::Point{std::min(way, 10.0), std::max(0.0, way - 10.0), 0.0};
    };
    time_s += 0.002;
    return error
        .update({.time_s = time_s,
                 .command_mm = at(place_mm),
                 .actual_mm = at(tool_mm),
                 .path = shown ? PathView(path) : PathView(),
                 .path_index = place_mm > 10.0 ? 1U : 0U,
                 .path_position_mm = place_mm,
                 .path_speed_mm_s = 50.0,
                 .in_cut = cuts})
        .in_cut;
  }
  std::vector<PathSegment> path;
  ContourError error = estimator();
  double time_s = 0.0;
};

TEST(ContourError, IsNoneOfARapidWhoseEndIsTheFirstThatIsSeen) {
  RapidThenCut fresh;
  EXPECT_FALSE(fresh.in_cut(10.2, 9.2, true, true));
  EXPECT_FALSE(fresh.in_cut(11.1, 10.1, true, true));
  EXPECT_TRUE(fresh.in_cut(11.3, 10.3, true, true));
  RapidThenCut found;  // the place is found as the cut begins
  EXPECT_FALSE(found.in_cut(9.0, 8.0, false, false));
  EXPECT_FALSE(found.in_cut(9.9, 8.9, false, false));
  EXPECT_FALSE(found.in_cut(10.2, 9.2, true, true));
  EXPECT_TRUE(found.in_cut(11.3, 10.3, true, true));
  EXPECT_TRUE(found.in_cut(11.4, 10.4, true, false)) << "lost within the cut";
  EXPECT_TRUE(found.in_cut(11.5, 10.5, true, true));
}

TEST(ContourError, IsNoneWhereTheControlTellsTheCutTooEarly) {
  RapidThenCut early;
  for (double s = 8.0; s < 12.0; s += 0.1) {
    EXPECT_EQ(early.in_cut(s, s - 1.0, true, true), s - 1.0 > 10.0) << s;
  }
}

TEST(ContourError, StaysOnItsOwnTurnOfANarrowSpiral) {
  // Pitch 0.2 mm: the neighbouring turn is nearer than the lag of 1 mm, and nearer than the error.
  const auto path =
      PathMaker({5, 0, 0}, 50.0).arc({0, 0, 0}, 10.0 * kTurn, {0, 0, 1}, 0.0, 2.0).path();
  ContourError error = estimator();
  Runner runner(path, 50.0, 50.0, 0.001);
  for (int i = 0; !runner.done(); ++i) {
    const auto input = runner.step();
    const auto output = error.update(input);
    ASSERT_TRUE(output.valid);
    ASSERT_LT(output.foot_position_mm, input.path_position_mm);
    ASSERT_GT(output.foot_position_mm, input.path_position_mm - 1.2);
    if (i > 200) {
      // R − R/√(1+q²) at the radius passed; the spiral's slow growth adds next to nothing.
      const double r = 5.0 + 2.0 * input.path_position_mm / path[0].length_mm;
      const double q = 50.0 / (r * 50.0);
      ASSERT_NEAR(output.error_mm, r - r / std::sqrt(1.0 + q * q), 0.004);
    }
  }
}

// The walls are 0.05 mm apart: the other one is 0.01 mm away, its own 0.04 mm.
TEST(ContourError, DoesNotSeeTheOtherWallOfASlot) {
  const auto path = PathMaker({0, 0, 0}, 50.0)
                        .line_to({50, 0, 0})
                        .line_to({50, 0.05, 0})
                        .line_to({0, 0.05, 0})
                        .path();
  ContourError error = estimator();
  // Well inside the way out, 0.04 mm off: the way back would be nearer.
  const auto output = error.update({0.0, {20, 0, 0}, {19, 0.04, 0}, path, 0, 20.0, 50.0});
  EXPECT_NEAR(output.error_mm, 0.04, 1e-12);
  EXPECT_EQ(output.foot_index, 0u);
}

RC_GTEST_PROP(ContourError, EqualsTheNearestPointThatTheLagPermits, ()) {
  // A path that wanders in one direction: no distant piece ever comes near.
  PathMaker maker({0, 0, 0}, 40.0);
  const int pieces = *rc::gen::inRange(3, 12);
  for (int i = 0; i < pieces; ++i) {
    const double size = *geometry::test::number(0.5, 8.0);
    switch (*rc::gen::inRange(0, 4)) {
      case 0:
        maker.line_to(geometry::add(maker.at(), {size, *geometry::test::number(-1.0, 1.0) * size,
                                                 *geometry::test::number(-0.2, 0.2)}));
        break;
      case 1:
        maker.arc(geometry::add(maker.at(), {size, 0, 0}), kTurn / 2.0, {0, 0, -1});
        break;
      case 2:
        maker.arc(geometry::add(maker.at(), {size, 0, 0}), kTurn / 2.0, {0, 0, 1},
                  *geometry::test::number(-1.0, 1.0));
        break;
      default:
        maker.arc(geometry::add(maker.at(), {size, 0, 0}), kTurn / 2.0, {0, 0, 1}, 0.0, 0.2 * size);
    }
  }
  const auto& path = maker.path();
  const double speed = *geometry::test::number(5.0, 60.0);
  const double gain = *geometry::test::number(30.0, 90.0);
  ContourError error = estimator(gain);
  Runner runner(path, speed, gain, 0.004);
  while (!runner.done()) {
    const auto input = runner.step();
    const auto output = error.update(input);
    RC_ASSERT(output.valid && output.complete);
    RC_ASSERT(std::abs(std::abs(output.error_mm) - nearest_of_all(path, input, gain)) <= 1e-9);
  }
}

// A path index beyond the path is the sender's bug, not a reason to read beyond the array.
TEST(ContourError, RefusesUnfitInputAndGoesOnAfterwards) {
  const auto path = PathMaker({0, 0, 0}, 50.0).line_to({100, 0, 0}).path();
  ContourError error = estimator();
  const double nan = std::numeric_limits<double>::quiet_NaN();
  EXPECT_FALSE(error.update({0.0, {nan, 0, 0}, {0, 0, 0}, path, 0, 0.0, 50.0}).valid);
  EXPECT_FALSE(error.update({0.0, {0, 0, 0}, {0, 0, 0}, path, 7, 0.0, 50.0}).valid);
  EXPECT_TRUE(error.update({0.0, {1, 0, 0}, {0.5, 0, 0}, path, 0, 1.0, 50.0}).valid);
}

TEST(ContourError, StateCanBeRestored) {
  const auto path = PathMaker({10, 0, 0}, 50.0).arc({0, 0, 0}, kTurn).path();
  ContourError first = estimator();
  Runner runner(path, 50.0, 50.0, 0.001);
  for (int i = 0; i < 100; ++i) {
    first.update(runner.step());
  }
  ContourError second = estimator();
  second.restore(first.state());
  const auto input = runner.step();
  EXPECT_EQ(first.update(input).foot_position_mm, second.update(input).foot_position_mm);
}

TEST(ContourError, RefusesAConfigurationOutsideOfItsRange) {
  ContourError::Config config;
  config.servo_gain_1_s = 0.0;
  EXPECT_FALSE(ContourError::make(config).has_value());
  config = {};
  config.plane_normal = {1, 1, 1};
  EXPECT_FALSE(ContourError::make(config).has_value());
}

}  // namespace
}  // namespace steadyrest::contour::online
