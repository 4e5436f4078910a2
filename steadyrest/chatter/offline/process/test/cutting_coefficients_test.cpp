// SPDX-License-Identifier: Apache-2.0
#include <cmath>
#include <numbers>

#include <gtest/gtest.h>

#include <steadyrest/chatter/offline/process/cutting_coefficients.hpp>
#include <steadyrest/chatter/offline/test/cuts.hpp>

namespace steadyrest::chatter::offline {
namespace {

constexpr double kPi = std::numbers::pi;

Process four_teeth(double immersion, Direction direction) {
  Process p = test::benchmark_cut(immersion, direction);
  p.tool.teeth = 4;
  return p;
}

// Altintas and Budak 1995: the directional coefficients averaged over the pitch, N/2π·[α] between
// entry and exit, with Kr as a share of Kt and F = ½·a·Kt·[A]·Δ.
TEST(CuttingCoefficients, AverageToTheDirectionalFactorsOfAltintasAndBudak) {
  for (const double immersion : {0.1, 0.3, 0.5, 0.8}) {
    const Process p = four_teeth(immersion, Direction::down);
    const CuttingCoefficients cutting(p, 0.0);
    constexpr int kSteps = 20000;
    Eigen::Matrix2d mean = Eigen::Matrix2d::Zero();
    for (int i = 0; i < kSteps; ++i) {
      for (std::size_t j = 0; j < 4; ++j) {
        mean += cutting.stiffness(j, 2.0 * kPi * (i + 0.5) / kSteps) / kSteps;
      }
    }
    const double kr = 200.0 / 600.0;
    const auto primitive = [kr](double f) {
      Eigen::Matrix2d a;
      a << std::cos(2 * f) - 2 * kr * f + kr * std::sin(2 * f),
          -std::sin(2 * f) - 2 * f + kr * std::cos(2 * f),
          -std::sin(2 * f) + 2 * f + kr * std::cos(2 * f),
          -std::cos(2 * f) - 2 * kr * f - kr * std::sin(2 * f);
      return a;
    };
    // Ours is the force against the displacement: F = −a·H·Δ.
    const Eigen::Matrix2d published = -0.5 * 600.0 * 4.0 / (2.0 * kPi) * 0.5 *
                                      (primitive(p.exit_rad()) - primitive(p.entry_rad()));
    EXPECT_LT((mean - published).norm(), 1e-3 * published.norm()) << immersion;
  }
}

// A tooth at 90° removes a chip along x: the radial force pushes back along x, the tangential one
// along y. At 45° both displacements count, by 1/√2 each.
TEST(CuttingCoefficients, AreTheForcesOfAToothByHand) {
  const CuttingCoefficients cutting(four_teeth(1.0, Direction::up), 0.0);
  const Eigen::Matrix2d square = cutting.stiffness(0, 0.5 * kPi);
  EXPECT_NEAR(square(0, 0), 200.0, 1e-9);
  EXPECT_NEAR(square(1, 0), -600.0, 1e-9);
  EXPECT_NEAR(square(0, 1), 0.0, 1e-9);
  EXPECT_NEAR(square(1, 1), 0.0, 1e-9);
  const Eigen::Matrix2d slanted = cutting.stiffness(0, 0.25 * kPi);
  EXPECT_NEAR(slanted(0, 0), 0.5 * (600.0 + 200.0), 1e-9);
  EXPECT_NEAR(slanted(0, 1), 0.5 * (600.0 + 200.0), 1e-9);
  EXPECT_NEAR(slanted(1, 0), 0.5 * (-600.0 + 200.0), 1e-9);
  // Tooth 1 follows a quarter turn behind.
  EXPECT_LT((cutting.stiffness(1, 0.75 * kPi) - slanted).norm(), 1e-9);
  EXPECT_EQ(cutting.stiffness(0, 1.25 * kPi).norm(), 0.0) << "out of the cut";
}

TEST(CuttingCoefficients, OfATurningToolActThroughTheChipAlongXAlone) {
  const CuttingCoefficients cutting(test::turned(0.02, 300.0), 0.0);
  for (const double angle : {0.0, 1.0, 4.0, 100.0}) {
    const Eigen::Matrix2d h = cutting.stiffness(0, angle);
    EXPECT_EQ(h(0, 0), 300.0);
    EXPECT_EQ(h(1, 0), 1.0);
    EXPECT_EQ(h.col(1).norm(), 0.0);
  }
  EXPECT_TRUE(cutting.corners_rad(0).empty()) << "smooth all round";
}

}  // namespace
}  // namespace steadyrest::chatter::offline
