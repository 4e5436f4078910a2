// SPDX-License-Identifier: Apache-2.0
#include <cmath>

#include <gtest/gtest.h>
#include <rapidcheck.h>

#include <steadyrest/sim/axis/friction.hpp>

namespace steadyrest::sim {
namespace {

using Law = kernel::machine::Friction;

// Stribeck: F(v) = Fc + (Fs − Fc)·exp(−(v/vs)²), so 1/e of the excess is left at v = vs. A
// breakaway below Coulomb friction counts as equal to it.
TEST(Friction, CurveFallsFromBreakawayToCoulomb) {
  const Law law{.coulomb_au_s2 = 200.0, .breakaway_au_s2 = 500.0, .stribeck_au_s = 2.0};
  EXPECT_DOUBLE_EQ(Friction(law, 1e-3).dry_mm_s2(0.0), 500.0);
  EXPECT_NEAR(Friction(law, 1e-3).dry_mm_s2(2.0), 200.0 + 300.0 * std::exp(-1.0), 1e-9);
  EXPECT_EQ(Friction(law, 1e-3).dry_mm_s2(100.0), 200.0);
  const Law odd{.coulomb_au_s2 = 200.0, .breakaway_au_s2 = 0.0};
  EXPECT_EQ(Friction(odd, 1e-3).dry_mm_s2(0.0), 200.0);
}

// Coulomb alone: t = v/a, x = v²/2a.
TEST(Friction, CoastDownStopsInTheClosedFormTimeAndDistance) {
  const Law law{.coulomb_au_s2 = 400.0, .breakaway_au_s2 = 400.0};
  const double h = 1e-4;
  double v = 80.0;
  double x = 0.0;
  int steps = 0;
  while (v != 0.0 && steps < 100000) {
    const double next = Friction(law, h).step(v, 0.0);
    x += 0.5 * h * (v + next);
    v = next;
    ++steps;
  }
  EXPECT_NEAR(steps * h, 80.0 / 400.0, 2.0 * h);
  EXPECT_NEAR(x, 80.0 * 80.0 / (2.0 * 400.0), 80.0 * h);
}

TEST(Friction, SticksBelowBreakawayAndSlipsAbove) {
  const Law law{.coulomb_au_s2 = 200.0, .breakaway_au_s2 = 500.0};
  EXPECT_EQ(Friction(law, 1e-4).step(0.0, 499.0), 0.0);
  EXPECT_EQ(Friction(law, 1e-4).step(0.0, -499.0), 0.0);
  EXPECT_GT(Friction(law, 1e-4).step(0.0, 501.0), 0.0);
  EXPECT_LT(Friction(law, 1e-4).step(0.0, -501.0), 0.0);
}

// At large steps an explicit friction overshoots zero and then reverses or drives the axis.
TEST(Friction, TakesEnergyAndNeverGivesIt) {
  EXPECT_TRUE(rc::check("work of friction is never positive", [] {
    const Law law{.coulomb_au_s2 = *rc::gen::inRange(0, 2000) * 1.0,
                  .breakaway_au_s2 = *rc::gen::inRange(0, 3000) * 1.0,
                  .stribeck_au_s = *rc::gen::inRange(1, 1000) * 0.01,
                  .viscous_1_s = *rc::gen::inRange(0, 50) * 1.0};
    const double h = *rc::gen::inRange(1, 1000) * 1e-6;
    const double v = *rc::gen::inRange(-50000, 50000) * 1e-2;
    const double u = *rc::gen::inRange(-5000, 5000) * 1.0;
    const double next = Friction(law, h).step(v, u);
    const double friction = (v + h * u - next) / h;
    RC_ASSERT(std::abs(next) <= std::abs(v + h * u));
    RC_ASSERT(friction * next >= 0.0);
    RC_ASSERT(next * (v + h * u) >= 0.0);  // never reversed by friction alone
  }));
}

}  // namespace
}  // namespace steadyrest::sim
