// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <vector>

#include <gtest/gtest.h>

#include <steadyrest/kernel/rt/testing/allocation_guard.hpp>
#include <steadyrest/sim/cut/cutting_process.hpp>
#include <steadyrest/sim/cut/test/cuts.hpp>

namespace steadyrest::sim {
namespace {

using std::numbers::pi;
using test::benchmark;
using test::made;
using test::mode;
using test::turns;

/// So stiff that it moves by nanometres.
Cutting rigid() {
  Cutting cut;
  cut.modes = {mode(1e9, 2000.0, 0.05), mode(1e9, 2000.0, 0.05, false)};
  return cut;
}

TEST(CuttingProcess, RigidToolHasTheForcesOfTheChip) {
  // Mean over a turn of a slot: Fx = −N·b·f·Kr/4, Fy = N·b·f·Kt/4 (Altintas, Manufacturing
  // Automation, 2.7.1), torque N·b·f·Kt·D/(2π).
  CuttingProcess process = made({.cut = rigid(), .slowest_rev_s = 50.0});
  const auto out = turns(process, {.speed_rev_s = 50.0, .feed_per_tooth_mm = 0.05}, 3);
  double fx = 0.0;
  double fy = 0.0;
  double torque = 0.0;
  const auto n = static_cast<double>(process.steps());
  for (std::size_t i = out.size() - process.steps(); i < out.size(); ++i) {
    fx += out[i].force_n[0] / n;
    fy += out[i].force_n[1] / n;
    torque += out[i].torque_n_m / n;
  }
  EXPECT_NEAR(fx, -2.0 * 0.05 * 200.0 / 4.0, 0.2);
  EXPECT_NEAR(fy, 2.0 * 0.05 * 600.0 / 4.0, 0.2);
  EXPECT_NEAR(torque, 2.0 / (2.0 * pi) * 2.0 * 600.0 * 0.05 * 5e-3, 2e-3);
}

// Runout r and −r: alternating chips of f − 2r and f + 2r. From 2r > f on one tooth cuts nothing,
// the other one 2f.
TEST(CuttingProcess, RunoutOverTheFeedLeavesTheCutToOneTooth) {
  Cutting cut = rigid();
  const auto thickest = [&](double runout_mm) {
    cut.runout_mm = {runout_mm, -runout_mm};
    CuttingProcess process = made({.cut = cut, .slowest_rev_s = 50.0});
    const auto out = turns(process, {.speed_rev_s = 50.0, .feed_per_tooth_mm = 0.05}, 6);
    // At the border of the halves both teeth are in the cut: skipped.
    const std::size_t half = process.steps() / 2;
    std::vector<double> of_half(2, 0.0);
    for (std::size_t cell = 1; cell < process.steps(); ++cell) {
      double& most = of_half[cell / half];
      if (cell != half) {
        most = std::max(most, out[out.size() - 1 - process.steps() + cell].chip_mm);
      }
    }
    std::ranges::sort(of_half);
    return of_half;
  };
  EXPECT_NEAR(thickest(0.01)[0], 0.05 - 0.02, 1e-4);
  EXPECT_NEAR(thickest(0.01)[1], 0.05 + 0.02, 1e-4);
  EXPECT_NEAR(thickest(0.04)[0], 0.0, 1e-9);
  EXPECT_NEAR(thickest(0.04)[1], 0.10, 1e-4);
}

// Statics: F = −b·(Kr·f + Kre), x = F/k, and the chip equals the feed once the tool is at rest.
TEST(CuttingProcess, StillTurningRestsWhereForceAndStiffnessMeet) {
  Cutting cut;
  cut.turning = true;
  cut.teeth = 1;
  cut.modes = {mode(2e4, 300.0, 0.2)};
  cut.depth_mm = 0.5;
  cut.edge_radial_n_mm = 10.0;
  CuttingProcess process = made({.cut = cut, .slowest_rev_s = 20.0});
  const auto last = turns(process, {.speed_rev_s = 20.0, .feed_per_tooth_mm = 0.1}, 60).back();
  EXPECT_NEAR(last.force_n[0], -0.5 * (200.0 * 0.1 + 10.0), 1e-6);
  EXPECT_NEAR(last.displacement_mm[0], last.force_n[0] / 2e4, 1e-9);
  EXPECT_NEAR(last.chip_mm, 0.1, 1e-9);
}

// Linear theory grows without limit; a tool that leaves the cut settles into a limit cycle.
TEST(CuttingProcess, ChatterStopsGrowingWhenTheToolLeavesTheCut) {
  CuttingProcess process = made({.cut = benchmark(2.0), .slowest_rev_s = 5000.0 / 60.0});
  const CuttingProcess::Input input{.speed_rev_s = 5000.0 / 60.0, .feed_per_tooth_mm = 0.05};
  const auto peak = [&] {
    double most = 0.0;
    for (const auto& o : turns(process, input, 100)) {
      most = std::max(most, std::abs(o.displacement_mm[0]));
    }
    return most;
  };
  peak();
  const double early = peak();
  const double late = peak();
  EXPECT_GT(late, 0.02);  // the linear vibration would have grown 10⁷⁰-fold
  EXPECT_LT(late, 1.0);
  EXPECT_NEAR(late, early, 0.3 * early);
}

TEST(CuttingProcess, WhatWasMissedIsCutByALaterPass) {
  // Turning, tool pulled back for a while: the next full turn meets everything that was left.
  Cutting cut;
  cut.turning = true;
  cut.teeth = 1;
  cut.modes = {mode(1e7, 50.0, 0.5)};
  CuttingProcess process = made({.cut = cut, .slowest_rev_s = 20.0});
  const CuttingProcess::Input input{.speed_rev_s = 20.0, .feed_per_tooth_mm = 0.05};
  turns(process, input, 2);
  process.disturb(-0.3);
  double chips = 0.0;
  double most = 0.0;
  const auto out = turns(process, input, 20);
  for (const auto& o : out) {
    chips += o.chip_mm / static_cast<double>(process.steps());
    most = std::max(most, o.chip_mm);
  }
  EXPECT_GT(most, 0.1);                 // more than two turns' feed at once
  EXPECT_NEAR(chips, 20 * 0.05, 1e-3);  // nothing is lost and nothing cut twice
}

// The tip generates the wall: the tool's deflection at that instant, one point per tooth.
TEST(CuttingProcess, TheWallShowsTheToolsDeflection) {
  Cutting cut;
  cut.modes = {mode(2e4, 3000.0, 0.1, false)};
  cut.exit_rad = pi / 3.0;
  CuttingProcess process = made({.cut = cut, .slowest_rev_s = 10.0});
  int walls = 0;
  const auto out = turns(process, {.speed_rev_s = 10.0, .feed_per_tooth_mm = 0.05}, 10);
  for (const auto& o : out) {
    walls += o.wall ? 1 : 0;
    if (o.wall) {
      EXPECT_NEAR(o.wall_mm, o.displacement_mm[1], 1e-12);
    }
  }
  EXPECT_EQ(walls, 20);
}

// Helix lag and uneven pitch shift the chips along the turn; their sum stays N·b·f in all.
TEST(CuttingProcess, HelixAndUnevenPitchKeepTheMeanForce) {
  Cutting cut = rigid();
  const auto mean = [&] {
    CuttingProcess process = made({.cut = cut, .slowest_rev_s = 50.0, .keeps_contact = true});
    const auto out = turns(process, {.speed_rev_s = 50.0, .feed_per_tooth_mm = 0.05}, 4);
    double sum = 0.0;
    for (std::size_t i = out.size() - process.steps(); i < out.size(); ++i) {
      sum += out[i].force_n[1] / static_cast<double>(process.steps());
    }
    return sum;
  };
  const double straight = mean();
  cut.helix_rad = 0.6;
  cut.depth_mm = 6.0;
  EXPECT_NEAR(mean() / 6.0, straight, 1e-3 * straight);
  cut.pitch_rad = {2.8, 2.0 * pi - 2.8};
  EXPECT_NEAR(mean() / 6.0, straight, 2e-3 * straight);
}

// A helix and a speed that changes at each step: the most work that a step can have.
TEST(CuttingProcess, StepsAllocateNothing) {
  Cutting cut = benchmark(3.0);
  cut.helix_rad = 0.5;
  CuttingProcess process = made({.cut = cut, .slowest_rev_s = 50.0});
  const kernel::rt::testing::AllocationGuard guard;
  for (std::size_t i = 0; i < 4 * process.steps(); ++i) {
    process.step({.speed_rev_s = 50.0 + static_cast<double>(i % 7), .feed_per_tooth_mm = 0.1});
  }
}

TEST(CuttingProcess, RefusesWhatIsNotACut) {
  constexpr double kNan = std::numeric_limits<double>::quiet_NaN();
  const auto refuses = [](auto&& change) {
    CuttingProcess::Config config{.cut = benchmark(1.0)};
    change(config);
    return !CuttingProcess::make(config).has_value();
  };
  EXPECT_FALSE(refuses([](auto&) {}));
  EXPECT_TRUE(refuses([](auto& c) { c.cut.modes.clear(); }));
  EXPECT_TRUE(refuses([](auto& c) { c.cut.modes[0].damping_ratio = -0.1; }));
  EXPECT_TRUE(refuses([](auto& c) { c.cut.modes[0].mass_kg = 0.0; }));
  EXPECT_TRUE(refuses([](auto& c) { c.cut.teeth = 0; }));
  EXPECT_TRUE(refuses([](auto& c) { c.cut.depth_mm = kNan; }));
  EXPECT_TRUE(refuses([](auto& c) { c.cut.exit_rad = -1.0; }));
  EXPECT_TRUE(refuses([](auto& c) { c.cut.runout_mm = {0.01}; }));
  EXPECT_TRUE(refuses([](auto& c) { c.slowest_rev_s = 0.0; }));
  EXPECT_TRUE(refuses([](auto& c) { c.slowest_rev_s = 0.002; }));  // over a million steps a turn
}

}  // namespace
}  // namespace steadyrest::sim
