// SPDX-License-Identifier: Apache-2.0
#include <cmath>
#include <complex>
#include <numbers>
#include <vector>

#include <gtest/gtest.h>

#include <steadyrest/chatter/offline/cycle/pass_matrix.hpp>
#include <steadyrest/chatter/offline/cycle/stability.hpp>
#include <steadyrest/chatter/offline/test/cuts.hpp>

namespace steadyrest::chatter::offline {
namespace {

using Xi = PassMatrix::Complex;

constexpr double kPassSpeed_rev_s = 5000.0 / 60.0;

Process one_mode() {
  return test::benchmark_cut(1.0, Direction::up);
}
Process two_modes() {
  Process p = test::benchmark_cut(0.5, Direction::up);
  p.modes.push_back({{0.6, 0.8}, 700.0, 0.03, 0.06});
  return p;
}

// Nothing is cut, so M is the free vibration: each mode gives 1 − 2ξ·e^(−ζωT)·cos(ω_d·T) +
// ξ²·e^(−2ζωT).
TEST(PassMatrix, WithoutADepthHasTheDeterminantOfTheFreeModes) {
  for (const Process& p : {one_mode(), two_modes()}) {
    const PassMatrix pass(p, kPassSpeed_rev_s, 1.0, 0.0);
    for (const Xi xi : {Xi(0.3, 0.0), Xi(-1.1, 0.4), Xi(0.0, 2.0)}) {
      Xi want = 1.0;
      for (const Mode& mode : p.modes) {
        const double turn = 2.0 * std::numbers::pi * mode.frequency_hz / (2.0 * kPassSpeed_rev_s);
        const double decay = std::exp(-mode.damping_ratio * turn);
        const double damped = std::sqrt(1.0 - mode.damping_ratio * mode.damping_ratio) * turn;
        want *= 1.0 - 2.0 * xi * decay * std::cos(damped) + xi * xi * decay * decay;
      }
      EXPECT_LT(std::abs(pass.g(xi, 0.0) - want), 1e-11) << xi;
    }
  }
}

// The collocation of the whole delay equation shares nothing with g but the forces.
TEST(PassMatrix, VanishesAtTheInverseOfEachDominantMultiplier) {
  for (const Process& p : {one_mode(), two_modes()}) {
    const PassMatrix pass(p, kPassSpeed_rev_s, 8.0, 0.0);
    for (const double depth_mm : {0.1, 0.5, 1.5}) {
      const Stability found = stability_at(p,
                                           {.speed_rev_s = kPassSpeed_rev_s,
                                            .modulation = {},
                                            .course = {},
                                            .most_depth_mm = depth_mm},
                                           {})
                                  .value();
      const Xi xi = 1.0 / found.multiplier;
      EXPECT_LT(std::abs(pass.g(xi, depth_mm)), 1e-7) << depth_mm;
      EXPECT_GT(std::abs(pass.g(1.02 * xi, depth_mm)), 1e-3) << "and not all round it";
    }
  }
}

TEST(PassMatrix, GivesFourAtOnceWhatItGivesSingly) {
  for (const Process& p : {one_mode(), two_modes()}) {
    const PassMatrix pass(p, kPassSpeed_rev_s, 4.0, 0.0);
    EXPECT_EQ(pass.functions(), p.modes.size() == 1 ? 1U : 16U);
    const PassMatrix::Lanes xi{Xi(0.2, 0.1), Xi(-0.9, 0.3), Xi(0.2, -0.1), Xi(1.3, 0.0)};
    const PassMatrix::Lanes g = pass.g_lanes(xi, 1.0);
    for (std::size_t i = 0; i < xi.size(); ++i) {
      EXPECT_LT(std::abs(g[i] - pass.g(xi[i], 1.0)), 1e-11 * (1.0 + std::abs(g[i]))) << i;
    }
    EXPECT_LT(std::abs(g[2] - std::conj(g[0])), 1e-12) << "g is real on the real axis";
    EXPECT_NE(g[0].imag(), 0.0);
  }
}

TEST(PassMatrix, IsForEvenPitchWithoutProcessDamping) {
  Process p = one_mode();
  EXPECT_TRUE(PassMatrix::simple(p));
  p.cut.process_damping_n_mm = 100.0;
  EXPECT_FALSE(PassMatrix::simple(p));
  p = one_mode();
  p.tool.pitch_rad = {3.0, 2.0 * std::numbers::pi - 3.0};
  EXPECT_FALSE(PassMatrix::simple(p));
}

}  // namespace
}  // namespace steadyrest::chatter::offline
