// SPDX-License-Identifier: Apache-2.0
#include <cmath>

#include <gtest/gtest.h>

#include <steadyrest/contour/online/contour_error.hpp>
#include <steadyrest/contour/online/test/path_runner.hpp>
#include <steadyrest/contour/online/test/paths.hpp>

namespace steadyrest::contour::online {
namespace {

using test::estimator;
using test::kTurn;
using test::PathMaker;
using test::Point;
using test::Runner;

struct CircleCase {
  double gain_1_s;
  double expected_mm;
};

class CirclesOfThePaper : public testing::TestWithParam<CircleCase> {};

// R = 10 mm, F4000: R − R/√(1 + (v/(R·k))²), both directions, with arcs, CAM chords and no path.
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

// The truth is constructed: the actual point is 0.1 rad behind the command and a known distance
// inside the circle, so ε is that distance to rounding, whatever servo would have brought it there.
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

// Chords of 0.01 mm have a sag of h²/(8R) = 1.25·10⁻⁶ mm: the two errors may differ by that much. A
// foot stuck at the corners of the chords would show as steps.
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

}  // namespace
}  // namespace steadyrest::contour::online
