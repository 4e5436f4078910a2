// SPDX-License-Identifier: Apache-2.0
#include <cmath>
#include <numbers>
#include <random>

#include <gtest/gtest.h>

#include <steadyrest/contour/offline/predistort/polish/planar_arc.hpp>

namespace steadyrest::contour::offline {
namespace {

using std::numbers::pi;

void expect_same(const Heading& a, const Heading& b) {
  EXPECT_NEAR(a.x_mm, b.x_mm, 1e-9);
  EXPECT_NEAR(a.y_mm, b.y_mm, 1e-9);
  EXPECT_NEAR(std::remainder(a.angle_rad - b.angle_rad, 2.0 * pi), 0.0, 1e-9);
}

TEST(PlanarArc, AQuarterOfACircleIsWhereItsRadiusSays) {
  const PlanarArc arc{{.x_mm = 1.0, .y_mm = 2.0, .angle_rad = 0.0}, 1.0 / 4.0, 2.0 * pi};
  expect_same(along(arc, arc.length_mm), {.x_mm = 5.0, .y_mm = 6.0, .angle_rad = pi / 2.0});
  expect_same(along(arc, -2.0 * pi), {.x_mm = -3.0, .y_mm = 6.0, .angle_rad = -pi / 2.0});
}

TEST(PlanarArc, TwoArcsGoFromPlaceToPlaceWithoutABend) {
  std::mt19937 random(7);
  std::uniform_real_distribution<double> place(-5.0, 5.0);
  std::uniform_real_distribution<double> angle(-2.0, 2.0);
  std::uniform_real_distribution<double> ratio(0.3, 3.0);
  int found = 0;
  for (int i = 0; i < 200; ++i) {
    const Heading from{.x_mm = place(random), .y_mm = place(random), .angle_rad = angle(random)};
    const Heading to{.x_mm = place(random), .y_mm = place(random), .angle_rad = angle(random)};
    const double rho = ratio(random);
    const auto arcs = biarc(from, to, rho);
    if (!arcs) {
      continue;
    }
    ++found;
    const auto& [one, two] = *arcs;
    expect_same(one.start, from);
    expect_same(two.start, along(one, one.length_mm));
    expect_same(along(two, two.length_mm), to);
    EXPECT_GT(one.length_mm, 0.0);
    EXPECT_GT(two.length_mm, 0.0);
    if (std::abs(one.curvature_1_mm * one.length_mm) < pi - 0.1 &&
        std::abs(two.curvature_1_mm * two.length_mm) < pi - 0.1) {
      EXPECT_NEAR(biarc_ratio(one, two), rho, 1e-6 * rho);
    }
  }
  EXPECT_GT(found, 100);
}

}  // namespace
}  // namespace steadyrest::contour::offline
