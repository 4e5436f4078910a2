// SPDX-License-Identifier: Apache-2.0
// A helical edge against slices of straight ones, each turned back by its lag.
#include <algorithm>
#include <cmath>
#include <numbers>

#include <gtest/gtest.h>

#include <steadyrest/chatter/offline/process/cutting_coefficients.hpp>
#include <steadyrest/chatter/offline/test/cuts.hpp>

namespace steadyrest::chatter::offline {
namespace {

constexpr double kRound = 2.0 * std::numbers::pi;

/// 30° of helix on a diameter of 10 mm: the edge lags by 0.1155 rad for each millimetre of depth.
Process helical(double immersion) {
  Process p = test::benchmark_cut(immersion, Direction::up);
  p.tool.diameter_mm = 10.0;
  p.tool.helix_rad = kRound / 12.0;
  p.cut.process_damping_n_mm = 500.0;
  return p;
}

// At 60 mm the edge winds round the tool more than once.
TEST(HelicalEdge, IsTheMeanOfItsSlices) {
  for (const double depth_mm : {0.5, 8.0, 60.0}) {
    const Process p = helical(0.3);
    Process straight = p;
    straight.tool.helix_rad = 0.0;
    const CuttingCoefficients whole(p, depth_mm);
    const CuttingCoefficients slice(straight, 0.0);
    for (const double angle : {0.2, 1.1, 1.7, 3.0, 5.9}) {
      constexpr int kSlices = 20000;
      Eigen::Matrix2d stiffness = Eigen::Matrix2d::Zero();
      Eigen::Matrix2d damping = Eigen::Matrix2d::Zero();
      for (int i = 0; i < kSlices; ++i) {
        const double z_mm = depth_mm * (i + 0.5) / kSlices;
        const double back = z_mm * std::tan(kRound / 12.0) / 5.0;
        stiffness += slice.stiffness(1, angle - back) / kSlices;
        damping += slice.damping(1, angle - back) / kSlices;
      }
      EXPECT_LT((whole.stiffness(1, angle) - stiffness).norm(), 0.2) << depth_mm << " " << angle;
      EXPECT_LT((whole.damping(1, angle) - damping).norm(), 5e-3) << depth_mm << " " << angle;
    }
  }
}

// The second difference over a small step shows a kink: there it is of the first order in the step,
// elsewhere of the second.
TEST(HelicalEdge, BendsAtItsCornersAndNowhereElse) {
  const Process p = helical(0.3);
  const CuttingCoefficients cutting(p, 4.0);
  const auto corners = cutting.corners_rad(0);
  ASSERT_EQ(corners.size(), 4U) << "tip and top, at entry and exit";
  const auto bend = [&](double angle, double step) {
    return (cutting.stiffness(0, angle + step) - 2.0 * cutting.stiffness(0, angle) +
            cutting.stiffness(0, angle - step))
        .norm();
  };
  constexpr double kStep = 1e-4;
  for (double angle = 0.0; angle < kRound; angle += 0.00731) {
    const bool apart = std::ranges::none_of(
        corners, [&](double c) { return std::abs(std::remainder(c - angle, kRound)) < 2 * kStep; });
    if (apart) {
      EXPECT_LT(bend(angle, kStep), 2e-4) << angle;
    }
  }
  for (const double corner : corners) {
    EXPECT_GT(bend(corner, kStep), 1e-2) << corner;
  }
}

}  // namespace
}  // namespace steadyrest::chatter::offline
