// SPDX-License-Identifier: Apache-2.0
#include <cmath>

#include <gtest/gtest.h>

#include <steadyrest/motion/offline/calculus/physical_limits.hpp>

namespace steadyrest::motion::offline {
namespace {

TEST(PhysicalLimits, LandauIsAttainedByChebyshevsPolynomial) {
  // ε·T₃ on the window W with T₃''' = 24: J = 24·ε·(2/W)³, end values T₃' = 9 and T₃'' = 24.
  constexpr double kEps = 5e-7;
  constexpr double kWindow = 3e-3;
  const double scale = 2.0 / kWindow;
  const MotionError least = landau_bound(kEps, 24.0 * kEps * std::pow(scale, 3));
  EXPECT_NEAR(least.velocity_mm_s, 9.0 * kEps * scale, 1e-9 * least.velocity_mm_s);
  EXPECT_NEAR(least.acceleration_mm_s2, 24.0 * kEps * scale * scale,
              1e-9 * least.acceleration_mm_s2);
}

TEST(PhysicalLimits, WorkedExamples) {
  // v = 10 mm/s, stamps of 100 ns, J = 5000 mm/s³.
  const EdgeQuality ideal{10.0, 0.001, 1e-7, 0.0, 5000.0};
  EXPECT_NEAR(guaranteed_floor(ideal).velocity_mm_s, 3.4e-3, 0.05e-3);
  EXPECT_NEAR(guaranteed_floor(ideal).acceleration_mm_s2, 6.7, 0.05);
  EXPECT_NEAR(stochastic_optimum(ideal).velocity_mm_s, 1.2e-3, 0.1e-3);
  EXPECT_NEAR(stochastic_optimum(ideal).acceleration_mm_s2, 3.4, 0.25);
  EdgeQuality lines = ideal;
  lines.line_error_mm = 0.05e-3;
  EXPECT_NEAR(guaranteed_floor(lines).velocity_mm_s, 0.072, 0.001);
  EXPECT_NEAR(guaranteed_floor(lines).acceleration_mm_s2, 31.0, 0.5);
  lines.line_error_mm = 0.02e-3;
  EXPECT_NEAR(stochastic_optimum(lines).velocity_mm_s, 0.013, 0.001);
  EXPECT_NEAR(stochastic_optimum(lines).acceleration_mm_s2, 11.0, 0.6);
}

TEST(PhysicalLimits, TheOptimumIsTheLeastOfAllWindows) {
  const EdgeQuality q{30.0, 0.001, 2e-7, 1e-5, 800.0};
  const double s = (std::pow(30.0 * 2e-7, 2) / 12.0 + 1e-10) * 0.001 / 30.0;
  double v = 1e9;
  double a = 1e9;
  for (double w = 1e-4; w < 0.1; w *= 1.0005) {
    v = std::min(v, std::hypot(std::sqrt(192.0 * s / std::pow(w, 3)), 80.0 * w * w));
    a = std::min(a, std::hypot(std::sqrt(720.0 * s / std::pow(w, 5)), 400.0 * w));
  }
  EXPECT_NEAR(stochastic_optimum(q).velocity_mm_s, v, 1e-5 * v);
  EXPECT_NEAR(stochastic_optimum(q).acceleration_mm_s2, a, 1e-5 * a);
}

TEST(PhysicalLimits, NoClockHelpsWhereEdgesAreFarApart) {
  // Two motions with the same edges: v·t ± the perfect spline of period 2D.
  constexpr double kJerk = 100.0;
  constexpr double kSpeed = 0.5;
  constexpr double kSpacing = 0.001 / kSpeed;
  const MotionError least = guaranteed_floor({kSpeed, 0.001, 0.0, 0.0, kJerk});
  // Velocity of the spline: a parabola between the extremes ±J·D²/8 at the edges, 0 half-way.
  EXPECT_NEAR(least.velocity_mm_s, kJerk * kSpacing * kSpacing / 8.0, 1e-12);
  EXPECT_NEAR(least.acceleration_mm_s2, kJerk * kSpacing / 2.0, 1e-12);
  // It must not reverse the axis.
  EXPECT_DOUBLE_EQ(guaranteed_floor({0.01, 0.001, 0.0, 0.0, 5000.0}).velocity_mm_s, 0.01);
}

}  // namespace
}  // namespace steadyrest::motion::offline
