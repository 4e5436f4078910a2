// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <cmath>
#include <cstddef>
#include <random>
#include <vector>

#include <gtest/gtest.h>

#include <steadyrest/chatter/online/free_share.hpp>
#include <steadyrest/chatter/online/lines/line_spectrum.hpp>
#include <steadyrest/kernel/units/constants.hpp>

// Bounds of the constants of free_share.cpp and line_spectrum.cpp: README, "What the constants do".
namespace steadyrest::chatter::online::test {
namespace {

using kernel::units::kTurn;

constexpr double kShareRate = 10e3;  // Hz
constexpr double kShareLineHz = 900.0;

/// A cutter of two teeth; the speed swings by `swing` at 12 Hz.
double share_angle_rev(double t_s, double speed_rev_s, double swing) {
  const double phase = kTurn * 12.0 * t_s;
  return speed_rev_s * (t_s + swing * (1.0 - std::cos(phase)) / (kTurn * 12.0));
}

/// `value(t_s, angle_rev)`, asked about 900 Hz at 0.2 s, of `rows` rows of 16 samples; 61: all.
template <class Value>
FreeShare::Output ask_about(double speed_rev_s, double swing, Value value, std::size_t rows = 61) {
  auto share = FreeShare::make({.sample_rate_hz = kShareRate, .teeth = 2});
  EXPECT_TRUE(share);
  FreeShare::Output out;
  for (int i = 0; i < 2300; ++i) {
    if (i == 2000) {
      share->ask(kShareLineHz, speed_rev_s, (rows + 3) * 16);
    }
    const double t = i / kShareRate;
    const double angle = share_angle_rev(t, speed_rev_s, swing);
    const auto& now = share->update(value(t, angle), angle);
    out = now.fresh ? now : out;
  }
  EXPECT_TRUE(out.known);
  return out;
}

/// The response of a mode of 900 Hz to the teeth's fifth order.
std::vector<double> response_of(double decay_1_s, double speed_rev_s, double swing) {
  constexpr int kFine = 8;
  const double w = kTurn * kShareLineHz;
  const double h = 1.0 / (kShareRate * kFine);
  double x = 0.0;
  double v = 0.0;
  std::vector<double> response;
  for (int i = 0; i < 2300 * kFine; ++i) {
    if (i % kFine == 0) {
      response.push_back(x);
    }
    const double force = std::cos(kTurn * 10.0 * share_angle_rev(i * h, speed_rev_s, swing));
    v += h * (0.1 * w * w * force - w * w * x - 2.0 * decay_1_s * v);
    x += h * v;
  }
  return response;
}

// ζ = 350/(2π·900) = 6 %: as much as a tool's mode has. All of it is forced.
TEST(DetectorShare, AModeThatDecaysAt350PerSecondLeavesNothingFree) {
  const auto response = response_of(350.0, 90.0, 0.15);
  const auto out = ask_about(90.0, 0.15, [&](double t, double) {
    return response[static_cast<std::size_t>(std::lround(t * kShareRate))];
  });
  EXPECT_LT(out.off_teeth, 0.01 * out.energy);
}

/// Nothing but an order, so nothing is free.
FreeShare::Output pure_order(double speed_rev_s, double order, std::size_t rows = 61) {
  return ask_about(
      speed_rev_s, 0.0, [&](double, double angle) { return std::cos(kTurn * order * angle); },
      rows);
}

// At 20 rev/s seven orders either side reach 140 Hz. At 10 rev/s they reach 70, and the teeth's
// alone are taken, which reach 140 again.
TEST(DetectorShare, KnowsRunoutAt20RevolutionsASecondAndToothOrders100HzAwayAt10) {
  const auto runout = pure_order(20.0, 47.0);
  EXPECT_LT(runout.off_spindle, 0.01 * runout.energy);
  const auto tooth = pure_order(10.0, 100.0);
  EXPECT_LT(tooth.off_teeth, 0.01 * tooth.energy);
}

// A fit with as many columns as rows would explain anything. 24 rows: of noise half the energy is
// left for each degree of freedom, since the best of three poles counts.
TEST(DetectorShare, LeavesNoiseInAShortPast) {
  std::mt19937_64 rng(1);
  std::normal_distribution<double> noise(0.0, 1.0);
  constexpr int kCases = 150;
  double left = 0.0;
  for (int i = 0; i < kCases; ++i) {
    const auto out = ask_about(45.0, 0.05, [&](double, double) { return noise(rng); }, 24);
    left += out.off_spindle / out.noise_share / kCases;
  }
  EXPECT_GT(left, 0.3);
  EXPECT_LT(left, 1.0);
}

// Order 23 is the eleventh of the thirteen within 300 Hz of the line; 20 rows are the least.
TEST(DetectorShare, KnowsRunoutInTheShortestPast) {
  const auto out = pure_order(45.0, 23.0, 20);
  EXPECT_LT(out.off_spindle, 0.01 * out.energy);
}

// At constant speed a mode's response to an order is that order again. Columns that say the same
// must not count twice, or their rounding would explain the chatter. What a damped mode that rings
// down from the start explains of a steady line over 0.1 s leaves 0.40.
TEST(DetectorShare, SaysTheSameOnceAtConstantSpeed) {
  const auto out =
      ask_about(90.0, 0.0, [](double t, double) { return std::cos(kTurn * 930.0 * t); });
  EXPECT_GT(out.off_teeth, 0.3 * out.energy);
  EXPECT_LT(out.off_teeth, 0.5 * out.energy);
}

// A bin of white noise is exponential: what bins above c times the mean have over it is c·e⁻ᶜ of
// all; c = 10: 4.5·10⁻⁴. Some 20 of 390 000 bins and a level that is estimated, so within a factor
// of 4; c = 5 gives 75 times as much.
TEST(DetectorShare, OfWhiteNoiseTenTimesEToTheMinusTenIsLines) {
  auto spectrum = LineSpectrum::make({});
  ASSERT_TRUE(spectrum);
  std::mt19937_64 rng(5);
  std::normal_distribution<double> noise(0.0, 1.0);
  double lines = 0.0;
  double rest = 0.0;
  for (int i = 0; i < 100000; ++i) {
    const auto& out = spectrum->update(noise(rng), {});
    lines += out.fresh ? out.line_energy : 0.0;
    rest += out.fresh ? out.noise_energy : 0.0;
  }
  const double expected = 10.0 * std::exp(-10.0);
  EXPECT_GT(lines / rest, 0.25 * expected);
  EXPECT_LT(lines / rest, 4.0 * expected);
}

}  // namespace
}  // namespace steadyrest::chatter::online::test
