// SPDX-License-Identifier: Apache-2.0
#include <cmath>
#include <limits>
#include <vector>

#include <gtest/gtest.h>
#include <rapidcheck/gtest.h>

#include <steadyrest/contour/online/contour_error.hpp>
#include <steadyrest/contour/online/test/paths.hpp>
#include <steadyrest/math/geometry/foot_point.hpp>
#include <steadyrest/math/geometry/test/segments.hpp>
#include <steadyrest/math/geometry/vector.hpp>

namespace steadyrest::contour::online {
namespace {

namespace geometry = math::geometry;
using kernel::signal::PathView;
using test::kTurn;
using test::PathMaker;
using test::PathSegment;
using test::Point;

/// A point that runs along a path at constant speed, and an ideal first-order servo behind it.
class Runner {
 public:
  Runner(PathView path, double speed_mm_s, double gain_1_s, double period_s)
      : path_(path), speed_(speed_mm_s), gain_(gain_1_s), period_(period_s) {
    actual_ = path.front().start_mm;
  }
  [[nodiscard]] bool done() const {
    return s_ >= path_.back().position_mm + path_.back().length_mm;
  }
  ContourError::Input step() {
    // Substeps make the servo's own integration error small beside what is tested.
    constexpr int kSub = 50;
    for (int i = 0; i < kSub; ++i) {
      s_ += speed_ * period_ / kSub;
      while (index_ + 1 < path_.size() && s_ > path_[index_ + 1].position_mm) {
        ++index_;
      }
      const Point before = command_;
      command_ = geometry::point_at(
          path_[index_], geometry::parameter_at(path_[index_], s_ - path_[index_].position_mm));
      if (time_s_ == 0.0 && i == 0) {
        continue;
      }
      const Point middle = geometry::scale(geometry::add(before, command_), 0.5);
      const double share = 1.0 - std::exp(-gain_ * period_ / kSub);
      actual_ = geometry::add_scaled(actual_, geometry::subtract(middle, actual_), share);
    }
    time_s_ += period_;
    return {time_s_, command_, actual_, path_, index_, s_, speed_};
  }

 private:
  PathView path_;
  double speed_;
  double gain_;
  double period_;
  double time_s_ = 0.0;
  double s_ = 0.0;
  std::size_t index_ = 0;
  Point command_{};
  Point actual_{};
};

/// The nearest point of all segments between the places that the lag permits.
/// The oracle: no search order, no skipping, every segment in the window by the geometry's own foot
/// point. It shares the window with the room, which the tests of spiral and slot check by
/// themselves.
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

ContourError estimator(double gain_1_s = 50.0) {
  ContourError::Config config;
  config.servo_gain_1_s = gain_1_s;
  return ContourError::make(config).value();
}

struct CircleCase {
  double gain_1_s;
  double expected_mm;
};

class CirclesOfThePaper : public testing::TestWithParam<CircleCase> {};

// R = 10 mm, F4000: R − R/√(1 + (v/(R·k))²), both directions, arcs and CAM chords and no path at
// all.
TEST_P(CirclesOfThePaper, HaveTheErrorOfTheClosedForm) {
  const auto [gain, expected] = GetParam();
  const double v = 4000.0 / 60.0;
  for (const double direction : {1.0, -1.0}) {
    const auto path =
        PathMaker({10, 0, 0}, v).arc({0, 0, 0}, 3.0 * kTurn, {0, 0, direction}).path();
    for (const bool with_path : {true, false}) {
      ContourError error = estimator(gain);
      Runner runner(path, v, gain, 0.001);
      ContourError::Output output;
      for (int i = 0; i < 2000; ++i) {
        ContourError::Input input = runner.step();
        if (!with_path) {
          input.path = {};
        }
        output = error.update(input);
      }
      ASSERT_TRUE(output.valid);
      EXPECT_TRUE(output.complete);
      const double size = with_path ? output.error_mm : std::abs(output.error_mm);
      EXPECT_NEAR(size, expected, 1e-4);  // the table has four digits
      EXPECT_EQ(output.left_mm > 0.0, direction > 0.0);
    }
  }
}

INSTANTIATE_TEST_SUITE_P(Gains, CirclesOfThePaper,
                         testing::Values(CircleCase{1000.0 / 60.0, 0.7152},
                                         CircleCase{2000.0 / 60.0, 0.1942},
                                         CircleCase{50.0, 0.0877},
                                         CircleCase{5000.0 / 60.0, 0.0319}));

// The truth is constructed: the actual point lies 0.1 rad behind the command and a known way
// inside of the circle, so ε is that way to rounding, whatever servo would have brought it there.
TEST(ContourError, IsExactOnACircleWhateverTheLag) {
  const double r = 10.0;
  const auto path = PathMaker({r, 0, 0}, 50.0).arc({0, 0, 0}, kTurn).path();
  ContourError error = estimator();
  for (double angle = 0.5; angle < 6.0; angle += 0.01) {
    const double inside = 0.05 * std::sin(17.0 * angle);  // both signs
    const Point actual{(r - inside) * std::cos(angle - 0.1), (r - inside) * std::sin(angle - 0.1),
                       0.0};
    const auto output = error.update(
        {angle, {r * std::cos(angle), r * std::sin(angle), 0}, actual, path, 0, r * angle, 50.0});
    EXPECT_NEAR(output.error_mm, inside, 1e-9);
    EXPECT_NEAR(output.foot_position_mm, r * (angle - 0.1), 1e-9);
  }
}

// Left of +X is +Y against a normal of +Z. A sign that followed the curvature here would be 0/0.
TEST(ContourError, OnALineIsPositiveToTheLeft) {
  const auto path = PathMaker({0, 0, 0}, 50.0).line_to({100, 0, 0}).path();
  ContourError error = estimator();
  EXPECT_NEAR(error.update({0.0, {50, 0, 0}, {49, 0.02, 0}, path, 0, 50.0, 50.0}).error_mm, 0.02,
              1e-12);
  EXPECT_NEAR(error.update({0.01, {50, 0, 0}, {49, -0.02, 0}, path, 0, 50.0, 50.0}).error_mm, -0.02,
              1e-12);
}

// 0.03 and 0.04 from the corner make 0.05: the distance to the corner, not to either leg's line.
TEST(ContourError, OutsideOfACornerIsMeasuredToTheCorner) {
  const auto path = PathMaker({0, 0, 0}, 50.0).line_to({10, 0, 0}).line_to({10, 10, 0}).path();
  ContourError error = estimator();
  const auto output = error.update({0.0, {10, 0.4, 0}, {10.03, -0.04, 0}, path, 1, 10.4, 50.0});
  EXPECT_NEAR(output.error_mm, -0.05, 1e-12);  // right of the travel: outside of a left turn
  EXPECT_NEAR(output.foot_position_mm, 10.0, 1e-12);
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

// The walls are 0.05 mm apart: the other one is 0.01 mm away, the own one 0.04 mm.
TEST(ContourError, DoesNotSeeTheOtherWallOfASlot) {
  const auto path = PathMaker({0, 0, 0}, 50.0)
                        .line_to({50, 0, 0})
                        .line_to({50, 0.05, 0})
                        .line_to({0, 0.05, 0})
                        .path();
  ContourError error = estimator();
  // Well inside of the way out, 0.04 mm off: the way back would be nearer.
  const auto output = error.update({0.0, {20, 0, 0}, {19, 0.04, 0}, path, 0, 20.0, 50.0});
  EXPECT_NEAR(output.error_mm, 0.04, 1e-12);
  EXPECT_EQ(output.foot_index, 0u);
}

// Chords of 0.01 mm have a sag of h²/(8R) = 1.25·10⁻⁶ mm: the two errors may differ by that much. A
// foot that hung at the corners of the chords would show as steps.
TEST(ContourError, IsTheSameOnCamChordsAsOnTheArc) {
  const auto arc = PathMaker({10, 0, 0}, 60.0).arc({0, 0, 0}, kTurn).path();
  const auto chords = PathMaker({10, 0, 0}, 60.0).chords({0, 0, 0}, kTurn, 0.01).path();
  ContourError on_arc = estimator();
  ContourError on_chords = estimator();
  Runner a(arc, 60.0, 50.0, 0.002);
  Runner c(chords, 60.0, 50.0, 0.002);
  while (!a.done() && !c.done()) {
    const auto first = on_arc.update(a.step());
    const auto second = on_chords.update(c.step());
    ASSERT_TRUE(second.complete);
    ASSERT_NEAR(std::abs(first.error_mm), std::abs(second.error_mm), 2e-6);  // sag h²/(8R)
  }
}

RC_GTEST_PROP(ContourError, EqualsTheNearestPointThatTheLagPermits, ()) {
  // A path that wanders in one direction: nowhere does a far piece come near.
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

// A path index beyond the path is a bug of the sender, not a reason to read beyond the array.
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
