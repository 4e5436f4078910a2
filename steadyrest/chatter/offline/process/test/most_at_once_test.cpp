// SPDX-License-Identifier: Apache-2.0
// Counted round the whole turn, with nothing known of where teeth enter and leave.
#include <algorithm>
#include <cmath>
#include <numbers>
#include <random>

#include <Eigen/SVD>
#include <gtest/gtest.h>

#include <steadyrest/chatter/offline/process/cutting_coefficients.hpp>
#include <steadyrest/chatter/offline/test/cuts.hpp>

namespace steadyrest::chatter::offline {
namespace {

constexpr double kAllRound = 2.0 * std::numbers::pi;

/// The largest ‖Σ H_j‖ over |(Kt, Kr)| at so many angles.
double counted(const Process& p, int angles) {
  const CuttingCoefficients cutting(p, 0.0);
  double most = 0.0;
  for (int i = 0; i < angles; ++i) {
    Eigen::Matrix2d sum = Eigen::Matrix2d::Zero();
    for (std::size_t j = 0; j < p.tool.teeth; ++j) {
      sum += cutting.stiffness(j, kAllRound * (i + 0.37) / angles);
    }
    most = std::max(most, Eigen::JacobiSVD<Eigen::Matrix2d>(sum).singularValues()[0]);
  }
  return most / std::hypot(p.cut.tangential_n_mm2, p.cut.radial_n_mm2);
}

Process drawn(std::mt19937_64& random) {
  std::uniform_real_distribution<double> share(0.0, 1.0);
  Process p = test::benchmark_cut(0.05 + 0.95 * share(random),
                                  share(random) < 0.5 ? Direction::up : Direction::down);
  p.tool.teeth = 1 + random() % 9;
  double sum = 0.0;
  for (std::size_t j = 0; j < p.tool.teeth && share(random) < 0.9; ++j) {
    p.tool.pitch_rad.push_back(0.5 + share(random));
    sum += p.tool.pitch_rad.back();
  }
  if (p.tool.pitch_rad.size() < p.tool.teeth) {
    p.tool.pitch_rad.clear();  // even
  }
  for (double& pitch : p.tool.pitch_rad) {
    pitch *= kAllRound / sum;
  }
  return p;
}

TEST(MostAtOnce, IsWhatCountingFinds) {
  std::mt19937_64 random(4);
  for (int i = 0; i < 40; ++i) {
    const Process p = drawn(random);
    const double most = CuttingCoefficients(p, 0.0).most_at_once();
    const double found = counted(p, 4000);
    EXPECT_LE(found, most * (1.0 + 1e-9)) << i;
    EXPECT_GE(found, most * (1.0 - 1e-9)) << i << ": " << p.tool.teeth << " teeth";
  }
}

// Full immersion: half of the teeth cut, and in pairs a quarter turn apart they stiffen both
// directions alike.
TEST(MostAtOnce, OfASlotIsAQuarterOfTheTeeth) {
  Process p = test::benchmark_cut(1.0, Direction::up);
  for (const std::size_t teeth : {4U, 8U, 16U}) {
    p.tool.teeth = teeth;
    EXPECT_NEAR(CuttingCoefficients(p, 0.0).most_at_once(), static_cast<double>(teeth) / 4.0, 1e-9);
  }
  p.tool.teeth = 2;
  EXPECT_NEAR(CuttingCoefficients(p, 0.0).most_at_once(), 1.0, 1e-9) << "one tooth at a time";
}

}  // namespace
}  // namespace steadyrest::chatter::offline
