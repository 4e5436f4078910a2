// SPDX-License-Identifier: Apache-2.0
#include <cmath>
#include <cstddef>
#include <random>
#include <vector>

#include <gtest/gtest.h>

#include <steadyrest/chatter/online/free_share.hpp>
#include <steadyrest/kernel/rt/testing/allocation_guard.hpp>
#include <steadyrest/kernel/units/constants.hpp>

namespace steadyrest::chatter::online {
namespace {

using kernel::units::kTurn;

constexpr double kRate = 10e3;
constexpr double kModeHz = 900.0;
constexpr double kDecay = 90.0;  // 1/s

struct Vibration {
  std::vector<double> value, angle_rev;
};

/// A mode driven by order 10, the fifth tooth order, which sweeps over it: 90 rev/s ± 15 % at
/// 12 Hz; `own` is the amplitude of an additional line.
Vibration sweep(double own, double runout, double noise) {
  // Semi-implicit Euler at eight steps a sample, which keeps the mode's frequency and decay.
  constexpr int kFine = 8;
  Vibration out;
  std::mt19937_64 rng(11);
  std::normal_distribution<double> gauss(0.0, 1.0);
  const double w = kTurn * kModeHz;
  const double h = 1.0 / (kRate * kFine);
  double x = 0.0;
  double v = 0.0;
  double angle = 0.0;
  for (int i = 0; i < 4000 * kFine; ++i) {
    const double t = i * h;
    if (i % kFine == 0) {
      out.value.push_back(x + own * std::cos(kTurn * 930.0 * t) + noise * gauss(rng));
      out.angle_rev.push_back(angle);
    }
    const double force = std::cos(kTurn * 10.0 * angle) + runout * std::sin(kTurn * 9.0 * angle);
    v += h * (0.1 * w * w * force - w * w * x - 2.0 * kDecay * v);
    x += h * v;
    angle += h * 90.0 * (1.0 + 0.15 * std::sin(kTurn * 12.0 * t));
  }
  return out;
}

FreeShare::Output ask(const Vibration& vibration, std::size_t teeth, double hz) {
  auto share = FreeShare::make({.sample_rate_hz = kRate, .teeth = teeth});
  EXPECT_TRUE(share);
  FreeShare::Output out;
  const kernel::rt::testing::AllocationGuard guard;
  for (std::size_t i = 0; i < vibration.value.size(); ++i) {
    if (i == 3000) {
      share->ask(hz, 90.0, i);
    }
    const auto& now = share->update(vibration.value[i], vibration.angle_rev[i]);
    out = now.fresh ? now : out;
  }
  return out;
}

// The false alarm of modulated cuts: this whole line is the mode's response to an order.
TEST(FreeShare, IsNextToNothingWhereAnOrderSweepsOverADampedMode) {
  const auto out = ask(sweep(0.0, 0.0, 0.0), 2, kModeHz);
  ASSERT_TRUE(out.known);
  EXPECT_GT(out.energy, 0.01);
  EXPECT_LT(out.off_teeth, 0.02 * out.energy);
  EXPECT_GE(out.off_teeth, 0.0);
}

// A decay within a quarter is enough: other poles are tried too.
TEST(FreeShare, NamesTheModesDecay) {
  const auto out = ask(sweep(0.0, 0.0, 1e-3), 2, kModeHz);
  EXPECT_NEAR(out.growth_1_s, -kDecay, 0.25 * kDecay);
}

TEST(FreeShare, IsTheLineThatNoOrderGives) {
  // 30 Hz from the mode, near enough to be taken for its ringing, and constant while the orders
  // sweep across it.
  const double own = 0.5;
  const auto out = ask(sweep(own, 0.0, 0.0), 2, 930.0);
  // A line of amplitude A has the energy A²/2; the fit may take some of it, hardly add to it.
  EXPECT_GT(out.off_teeth, 0.5 * 0.5 * own * own);
  EXPECT_LT(out.off_teeth, 1.3 * 0.5 * own * own);
  EXPECT_GT(out.off_spindle, 0.4 * 0.5 * own * own);
}

// Order 9 is not a multiple of two teeth but is a spindle order.
TEST(FreeShare, RunoutIsOffTheTeethButNotOffTheSpindle) {
  const auto out = ask(sweep(0.0, 1.0, 0.0), 2, kModeHz);
  EXPECT_GT(out.off_teeth, 0.1 * out.energy);
  EXPECT_LT(out.off_spindle, 0.03 * out.energy);
}

// Seven places in the band, because a single one scatters by some 20 %.
TEST(FreeShare, NoiseKeepsItsShareOfTheBand) {
  Vibration noise = sweep(0.0, 0.0, 1.0);
  std::mt19937_64 rng(3);
  std::normal_distribution<double> gauss(0.0, 1.0);
  for (double& v : noise.value) {
    v = gauss(rng);
  }
  double sum = 0.0;
  const std::vector<double> lines{600.0, 900.0, 1500.0, 2200.0, 2900.0, 3600.0, 4200.0};
  for (const double hz : lines) {
    const auto out = ask(noise, 2, hz);
    sum += out.energy / out.noise_share / static_cast<double>(lines.size());
  }
  EXPECT_NEAR(sum, 1.0, 0.3);
}

// 100 samples fill 6 rows of 16 samples; 20 are the least.
TEST(FreeShare, IsNotKnownOfAShortPastAndRefusesWhatIsOutOfRange) {
  auto share = FreeShare::make({});
  ASSERT_TRUE(share);
  share->ask(900.0, 90.0, 100);
  bool fresh = false;
  for (int i = 0; i < 2000; ++i) {
    const auto& out = share->update(1.0, 0.009 * i);
    fresh = fresh || out.fresh;
    EXPECT_FALSE(out.known);
  }
  EXPECT_TRUE(fresh);
  EXPECT_FALSE(share->busy());
  EXPECT_FALSE(FreeShare::make({.sample_rate_hz = 60e3}));
  EXPECT_FALSE(FreeShare::make({.teeth = 65}));
}

}  // namespace
}  // namespace steadyrest::chatter::online
