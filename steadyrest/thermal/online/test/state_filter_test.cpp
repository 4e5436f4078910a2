// SPDX-License-Identifier: Apache-2.0
#include <cmath>
#include <random>

#include <gtest/gtest.h>

#include <steadyrest/kernel/rt/testing/allocation_guard.hpp>
#include <steadyrest/kernel/units/constants.hpp>
#include <steadyrest/thermal/online/state_filter.hpp>
#include <steadyrest/thermal/online/test/turning.hpp>
#include <steadyrest/thermal/online/test/two_modes.hpp>

namespace steadyrest::thermal::online {
namespace {

using kernel::machine::ThermalAxis;
using kernel::outcome::Reason;
using kernel::units::kNan;
using test::made;
using test::turning;
using test::two_modes;

/// A machine that matches the filter's assumptions: gain, drift and noise drawn from its own laws.
class Machine {
 public:
  Machine(const ThermalAxis& axis, double gain, std::mt19937& random)
      : axis_(axis), gain_(gain), random_(random) {}

  double after(double h, double speed) {
    for (std::size_t i = 0; i < 2; ++i) {
      const auto& m = axis_.mode[i];
      const double tau = speed == 0.0 && m.rest_tau_s > 0.0 ? m.rest_tau_s : m.tau_s;
      const double level = gain_ * m.level_mm[1] * speed / 100.0;
      x_[i] = level + (x_[i] - level) * std::exp(-h / tau);
    }
    const double left = std::exp(-h / axis_.drift_tau_s);
    d_ = left * d_ + axis_.drift_mm * std::sqrt(1.0 - left * left) * normal_(random_);
    return x_[0] + x_[1] + d_;
  }
  double reading(double truth) { return truth + axis_.noise_mm * normal_(random_); }

 private:
  ThermalAxis axis_;
  double gain_;
  std::mt19937& random_;
  std::normal_distribution<double> normal_;
  std::array<double, 2> x_{};
  double d_ = 0.0;
};

TEST(StateFilter, ItsInnovationsAreAsWideAsItSaysAndItsBandCovers) {
  std::mt19937 random(7);
  std::normal_distribution<double> normal;
  std::uniform_real_distribution<double> speed(0.0, 100.0);
  const StateFilter::Config config{.axis = two_modes(), .gate_sd = 10.0};
  constexpr int kMachines = 1000;
  constexpr int kReadings = 16;
  double energy = 0.0;
  double in_a_row = 0.0;
  int covered = 0;
  int alarmed = 0;
  for (int m = 0; m < kMachines; ++m) {
    Machine machine(config.axis, 1.0 + config.gain_sd_ratio * normal(random), random);
    StateFilter filter = made(config);
    double before = 0.0;
    bool alarm = false;
    for (int k = 0; k < kReadings; ++k) {
      const double n = speed(random);
      // The machine is drawn from the filter's own assumptions, so each figure below has a known
      // law: e² has the mean 1, successive e are uncorrelated, 95 % lie within 1.96.
      const double truth = machine.after(1800.0, n);
      filter.update(1800.0, turning(n));
      covered += std::abs(truth - filter.displacement_mm()) <= 1.96 * filter.sd_mm() ? 1 : 0;
      const auto verdict = filter.measure({.displacement_mm = machine.reading(truth)});
      const double e = verdict.innovation_mm / verdict.innovation_sd_mm;
      energy += e * e;
      in_a_row += e * before;
      before = e;
      alarm = alarm || filter.fault() != Reason::none;
    }
    alarmed += alarm ? 1 : 0;
  }
  constexpr double kAll = kMachines * kReadings;
  // Five standard deviations of χ² and of the binomial law.
  EXPECT_NEAR(energy / kAll, 1.0, 5.0 * std::sqrt(2.0 / kAll));
  EXPECT_NEAR(in_a_row / kAll, 0.0, 5.0 / std::sqrt(kAll)) << "white";
  EXPECT_NEAR(covered / kAll, 0.95, 5.0 * std::sqrt(0.95 * 0.05 / kAll));
  // Two tests at 0.1 % each, evaluated thirteen times, not independent.
  EXPECT_LT(alarmed, kMachines * 3 / 100) << "in a day of sixteen readings";
}

TEST(StateFilter, LearnsTheScaleOfItsLevels) {
  std::mt19937 random(3);
  StateFilter::Config config{.axis = two_modes(), .gain_sd_ratio = 0.2};
  config.axis.drift_mm = 0.0005;
  Machine machine(config.axis, 1.2, random);
  StateFilter filter = made(config);
  StateFilter unaware = made({.axis = config.axis, .gain_sd_ratio = 0.0});
  for (int k = 0; k < 6; ++k) {
    const double truth = machine.after(1800.0, 80.0);
    filter.update(1800.0, turning(80.0));
    unaware.update(1800.0, turning(80.0));
    EXPECT_EQ(filter.measure({.displacement_mm = machine.reading(truth)}).reason,
              Reason::thermal_reading_taken);
  }
  // Without the scale the same readings end up in the bias, which fades, and the next two hours go
  // wrong.
  EXPECT_NEAR(filter.gain(), 1.2, 0.03);
  EXPECT_EQ(unaware.gain(), 1.0);
  const double truth = machine.after(7200.0, 80.0);
  EXPECT_NEAR(filter.update(7200.0, turning(80.0)), truth, 0.0015);
  EXPECT_GT(std::abs(unaware.update(7200.0, turning(80.0)) - truth), 0.005);
}

TEST(StateFilter, AnOutlierChangesNothingAndAloneSaysNothing) {
  StateFilter filter = made({.axis = two_modes()});
  filter.update(3600.0, turning(60.0));
  const double before = filter.displacement_mm();
  const double sd = filter.sd_mm();
  const auto verdict = filter.measure({.displacement_mm = before + 5.0});
  EXPECT_EQ(verdict.reason, Reason::thermal_reading_outlier);
  EXPECT_EQ(filter.displacement_mm(), before);
  EXPECT_EQ(filter.sd_mm(), sd);
  for (int k = 0; k < 11; ++k) {
    filter.update(600.0, turning(60.0));
    filter.measure({.displacement_mm = filter.displacement_mm()});
    EXPECT_EQ(filter.fault(), Reason::none) << k;
  }
}

TEST(StateFilter, SaysWhenTheModelNoLongerFitsAndWhenItDoesAgain) {
  StateFilter filter = made({.axis = two_modes()});
  int readings = 0;
  while (filter.fault() == Reason::none && readings < 12) {
    filter.update(1800.0, turning(80.0));
    filter.measure({.displacement_mm = 3.0 * filter.model().displacement_mm() + 0.05});
    ++readings;
  }
  EXPECT_LE(readings, 5) << "a machine that grows thrice as much";
  EXPECT_EQ(filter.fault(), Reason::thermal_model_unfit);
  filter.rezero({.displacement_mm = 0.08, .sd_mm = 0.001});
  EXPECT_EQ(filter.fault(), Reason::none);
  EXPECT_NEAR(filter.displacement_mm(), 0.08, 1e-12);
  // rezero() sets d = z − Σx, so the sum is z with the reading's variance.
  EXPECT_NEAR(filter.sd_mm(), 0.001, 1e-9) << "as sure as the reading";
}

// 0.7 µm at 0.5 µm of noise: each reading passes the gate and χ²; only the sum reveals it.
TEST(StateFilter, ASmallErrorThatStaysIsToldFromNoise) {
  StateFilter::Config config{.axis = two_modes(), .gain_sd_ratio = 0.0};
  config.axis.drift_mm = 0.0;
  config.walk_mm_sqrt_s = 0.0;
  StateFilter filter = made(config);
  int readings = 0;
  while (filter.fault() == Reason::none && readings < 40) {
    filter.update(600.0, turning(50.0));
    filter.measure({.displacement_mm = filter.displacement_mm() + 0.0007});
    ++readings;
  }
  EXPECT_LE(readings, 12) << "1.4 standard deviations, every time to one side";
  EXPECT_GE(readings, 4);
}

// A bias of 10 µm at most against a reading of 500: clamped, and reported so.
TEST(StateFilter, HoldsBiasAndScaleWithinTheirLimits) {
  StateFilter filter =
      made({.axis = two_modes(), .start_sd_mm = 1.0, .gain_sd_ratio = 0.0, .max_bias_mm = 0.01});
  const auto verdict = filter.measure({.displacement_mm = 0.5});
  EXPECT_EQ(verdict.reason, Reason::thermal_reading_taken);
  EXPECT_TRUE(verdict.clamped);
  EXPECT_EQ(filter.bias_mm(), 0.01);
  EXPECT_EQ(filter.fault(), Reason::thermal_model_unfit);
}

TEST(StateFilter, UnfitInputChangesNothing) {
  StateFilter filter = made({.axis = two_modes()});
  const double before = filter.update(600.0, turning(50.0));
  const double sd = filter.sd_mm();
  EXPECT_EQ(filter.update(-1.0, turning(50.0)), before);
  EXPECT_EQ(filter.update(kNan, turning(50.0)), before);
  EXPECT_EQ(filter.update(1.0, turning(kNan)), before);
  EXPECT_EQ(filter.measure({.displacement_mm = kNan}).reason, Reason::input_not_finite);
  EXPECT_EQ(filter.measure({.displacement_mm = 0.0, .sd_mm = -1.0}).reason,
            Reason::input_not_finite);
  filter.rezero({.displacement_mm = kNan});
  EXPECT_EQ(filter.displacement_mm(), before);
  EXPECT_EQ(filter.sd_mm(), sd);
}

TEST(StateFilter, GoesOnFromARestoredStateAndStartsAnewFromABadOne) {
  StateFilter filter = made({.axis = two_modes()});
  filter.update(3000.0, turning(70.0));
  filter.measure({.displacement_mm = 0.021});
  StateFilter other = made({.axis = two_modes()});
  other.restore(filter.state());
  EXPECT_EQ(other.update(500.0, turning(20.0)), filter.update(500.0, turning(20.0)));
  EXPECT_EQ(other.measure({.displacement_mm = 0.02}).innovation_sd_mm,
            filter.measure({.displacement_mm = 0.02}).innovation_sd_mm);
  StateFilter::State bad = filter.state();
  bad.covariance[1][2] = kNan;
  other.restore(bad);
  EXPECT_EQ(other.displacement_mm(), 0.0);
  ThermalModel::State warm;
  warm.mode_mm = {0.004, 0.006, 0.0, 0.0};
  other.start(warm);
  EXPECT_NEAR(other.displacement_mm(), 0.010, 1e-15);
}

TEST(StateFilter, RefusesASetUpThatIsNone) {
  EXPECT_FALSE(StateFilter::make({.axis = two_modes(), .gain_sd_ratio = -0.1}));
  EXPECT_FALSE(StateFilter::make({.axis = two_modes(), .gate_sd = 0.0}));
  EXPECT_FALSE(StateFilter::make({.axis = two_modes(), .min_gain = 1.5}));
  EXPECT_FALSE(StateFilter::make({.axis = two_modes(), .start_sd_mm = kNan}));
}

TEST(StateFilter, DoesNotAllocateInTheCycle) {
  StateFilter filter = made({.axis = two_modes()});
  const kernel::rt::testing::AllocationGuard guard;
  for (int k = 0; k < 100; ++k) {
    filter.update(0.01 * k, turning(k));
    filter.measure({.displacement_mm = 0.001});
    filter.rezero({.displacement_mm = 0.001});
    filter.restore(filter.state());
  }
  EXPECT_EQ(guard.allocations(), 0U);
}

}  // namespace
}  // namespace steadyrest::thermal::online
