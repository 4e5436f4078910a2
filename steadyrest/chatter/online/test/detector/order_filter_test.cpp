// SPDX-License-Identifier: Apache-2.0
#include <cmath>
#include <numbers>
#include <random>
#include <string>

#include <gtest/gtest.h>

#include <steadyrest/chatter/online/lines/line_spectrum.hpp>
#include <steadyrest/chatter/online/orders/order_filter.hpp>
#include <steadyrest/chatter/online/revolution_spread.hpp>
#include <steadyrest/kernel/units/constants.hpp>

namespace steadyrest::chatter::online {
namespace {

using kernel::units::kTurn;

constexpr double kDefaultRate = 10e3;  // Hz

/// RMS of the residual over the last half of 2 s, 80 rev/s ± 10 % at 5 Hz when modulated.
double residual_of(OrderFilter& filter, bool modulated, double order, double hz) {
  double angle = 0.0;
  double squares = 0.0;
  for (int i = 0; i < 20000; ++i) {
    const double t = i / kDefaultRate;
    const double speed = 80.0 * (1.0 + (modulated ? 0.1 * std::sin(kTurn * 5.0 * t) : 0.0));
    const double value =
        hz > 0.0 ? std::cos(kTurn * hz * t) : std::cos(kTurn * order * angle + 0.4) + 0.3;
    const double e = filter.update(value, angle, speed, modulated, false).residual;
    squares += i >= 10000 ? e * e : 0.0;
    angle += speed / kDefaultRate;
  }
  return std::sqrt(squares / 10000.0);
}

// Two teeth: orders 2, 6 and 20 are the first, third and tenth of the teeth.
TEST(OrderFilter, TakesOutWhatRepeatsWithTheTeethAtAnySpeedLaw) {
  for (const double order : {2.0, 6.0, 20.0}) {
    for (const bool modulated : {false, true}) {
      auto filter = OrderFilter::make({});
      ASSERT_TRUE(filter);
      EXPECT_LT(residual_of(*filter, modulated, order, 0.0), 1e-3) << order;
    }
  }
}

// A filter that also took out chatter would leave nothing to detect.
TEST(OrderFilter, LeavesALineBetweenTheOrders) {
  auto filter = OrderFilter::make({});
  ASSERT_TRUE(filter);
  // 922 Hz at 80 rev/s is order 11.5, between all orders; a unit cosine has the RMS 1/√2.
  EXPECT_NEAR(residual_of(*filter, false, 0.0, 922.0), std::numbers::sqrt2 / 2.0, 0.05);
}

TEST(OrderFilter, RefusesWhatIsOutOfRange) {
  EXPECT_FALSE(OrderFilter::make({.sample_rate_hz = 999.0}));
  EXPECT_FALSE(OrderFilter::make({.teeth = 0}));
  EXPECT_FALSE(OrderFilter::make({.tooth_harmonics = 0}));
  EXPECT_FALSE(OrderFilter::make({.tooth_memory_rev = std::nan("")}));
}

// Amplitude 2: energy 2²/2 = 2.
TEST(LineSpectrum, NamesALineWithinAFiftiethOfABin) {
  for (const double hz : {313.0, 922.2, 1777.7, 4100.4}) {
    auto spectrum = LineSpectrum::make({});
    ASSERT_TRUE(spectrum);
    LineSpectrum::Output last;
    for (int i = 0; i < 3000; ++i) {
      last = spectrum->update(2.0 * std::cos(kTurn * hz * i / kDefaultRate), {});
    }
    EXPECT_NEAR(last.strongest.frequency_hz, hz, 0.02 * spectrum->resolution_hz()) << hz;
    EXPECT_NEAR(last.line_energy, 2.0, 0.02) << hz;
  }
}

// The highest of 500 exponential bins in 780 spectra is about ln 390 000 ≈ 13 times the mean; 25 is
// the threshold of the detector for a line.
TEST(LineSpectrum, NoiseHasNoLineAndKeepsItsEnergy) {
  auto spectrum = LineSpectrum::make({});
  ASSERT_TRUE(spectrum);
  std::mt19937_64 rng(3);
  std::normal_distribution<double> noise(0.0, 1.0);
  double energy = 0.0;
  double highest = 0.0;
  int spectra = 0;
  for (int i = 0; i < 100000; ++i) {
    const auto& out = spectrum->update(noise(rng), {});
    if (out.fresh) {
      ++spectra;
      energy += out.noise_energy;
      highest = std::max(highest, out.strongest.peak_ratio);
    }
  }
  EXPECT_NEAR(energy / spectra, 1.0, 0.05);
  EXPECT_GT(highest, 5.0);
  EXPECT_LT(highest, 25.0);
}

// 60 rev/s: 334 Hz lies between orders 5 and 6, 309 Hz within a bin of order 5.
TEST(LineSpectrum, NamesTheStrongestLineBesideTheOrders) {
  for (const double hz : {334.0, 309.0}) {
    auto spectrum = LineSpectrum::make({});
    ASSERT_TRUE(spectrum);
    LineSpectrum::Output last;
    for (int i = 0; i < 3000; ++i) {
      const double t = i / kDefaultRate;
      last = spectrum->update(std::cos(kTurn * 300.0 * t) + 0.5 * std::cos(kTurn * hz * t),
                              {.spindle_hz = 60.0});
    }
    if (hz == 334.0) {
      EXPECT_NEAR(last.strongest.frequency_hz, 300.0, 0.5);
      EXPECT_NEAR(last.beside.frequency_hz, hz, 0.5);
      EXPECT_NEAR(last.beside.energy, 0.125, 0.015);
    } else {
      EXPECT_EQ(last.beside.frequency_hz, 0.0);
    }
  }
}

// 500 Hz is twice the spacing and a hundred times as strong; only the guard hides it.
TEST(LineSpectrum, DoesNotLookWhereItIsTold) {
  auto spectrum = LineSpectrum::make({});
  ASSERT_TRUE(spectrum);
  LineSpectrum::Output last;
  for (int i = 0; i < 3000; ++i) {
    const double t = i / kDefaultRate;
    last = spectrum->update(std::cos(kTurn * 500.0 * t) + 0.01 * std::cos(kTurn * 777.0 * t),
                            {.spacing_hz = 250.0, .guard_hz = 30.0});
  }
  EXPECT_NEAR(last.strongest.frequency_hz, 777.0, 1.0);
}

// ½·E(x(θ) − x(θ − 1))² of cos 2πkθ is E·(1 − cos 2πk): 0, 1 and 2 for orders 3, 3¼ and 3½.
TEST(RevolutionSpread, IsZeroForARepeatingCutAndOneLessCosineForALine) {
  for (const double order : {3.0, 3.25, 3.5}) {
    RevolutionSpread spread;
    RevolutionSpread::Output last;
    double angle = 0.0;
    double changed = 0.0;
    double energy = 0.0;
    for (int i = 0; i < 20000; ++i) {
      last = spread.update(std::cos(kTurn * order * angle), angle);
      changed += last.known ? last.changed_energy : 0.0;
      energy += last.known ? last.energy : 0.0;
      angle += 25.0 / kDefaultRate * (1.0 + 0.1 * std::sin(kTurn * 5.0 * i / kDefaultRate));
    }
    ASSERT_TRUE(last.known);
    EXPECT_NEAR(changed / energy, 1.0 - std::cos(kTurn * order), 0.02) << order;
  }
}

// Scalar variances p about noise of 1: the same sample twice, at one angle, leaves 1/(1 + Σp) the
// second time. Two orders of 10 each at the start, as in the source.
TEST(OrderFilter, BelievesTheFirstSampleAsTheSourceDoes) {
  OrderFilter filter =
      OrderFilter::make({.teeth = 1, .tooth_harmonics = 1, .spindle_harmonics = 1}).value();
  filter.update(1.0, 0.1, 1e-9, false, false);
  EXPECT_NEAR(filter.update(1.0, 0.1, 1e-9, false, false).residual, 1.0 / 21.0, 1e-9);
}

// In a new cut runout starts as if 100 samples had been seen, so that chatter near a spindle order
// has time to show: p = 1/(100 + n/2) after n samples, and of runout that begins at n₀ the share
// (100 + n₀/2)/(100 + n/2) remains. First a revolution passes in which the tooth orders, learnt at
// once, settle.
TEST(OrderFilter, LearnsHalfTheRunoutOfANewCutInTwoRevolutionsOf200Samples) {
  constexpr int kTurnSamples = 200;
  OrderFilter filter = OrderFilter::make({.teeth = 4,
                                          .tooth_harmonics = 1,
                                          .spindle_harmonics = 3,
                                          .runout_memory_rev = 1000.0,
                                          .half_memory_rev = 1000.0})
                           .value();
  filter.open(false);
  double energy = 0.0;
  for (int i = 0; i < 4 * kTurnSamples; ++i) {
    const double angle_rev = static_cast<double>(i) / kTurnSamples;
    const double value = i < kTurnSamples ? 0.0 : std::cos(3.0 * kTurn * angle_rev);
    const double residual =
        filter.update(value, angle_rev, kDefaultRate / kTurnSamples, false, false).residual;
    // The revolution about the 600th sample.
    energy += std::abs(i - 3 * kTurnSamples) < kTurnSamples / 2 ? residual * residual : 0.0;
  }
  EXPECT_NEAR(std::sqrt(2.0 * energy / kTurnSamples), 200.0 / 400.0, 0.03);
}

}  // namespace
}  // namespace steadyrest::chatter::online
