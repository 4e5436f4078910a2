// SPDX-License-Identifier: Apache-2.0
#include <cmath>
#include <numbers>

#include <gtest/gtest.h>

#include <steadyrest/kernel/rt/testing/allocation_guard.hpp>
#include <steadyrest/sim/cut/cutting_vibration.hpp>

namespace steadyrest::sim {
namespace {

constexpr double kSpeed_rev_s = 5000.0 / 60.0;
constexpr double kPeriod_s = 0.002;

/// Two teeth, slot, 922 Hz: at 5000 rpm its border is at 0.4086 mm (Insperger and Stépán's
/// benchmark; the chatter room's reference has the digits).
CuttingVibration::Config benchmark_config(double depth_mm) {
  CuttingVibration::Config config;
  config.cut.modes = {
      CuttingMode{.frequency_hz = 922.0, .damping_ratio = 0.011, .mass_kg = 0.03993}};
  config.cut.depth_mm = depth_mm;
  config.slowest_rev_s = kSpeed_rev_s;
  return config;
}

CuttingVibration::Input cutting(double feed_per_tooth_mm = 0.1) {
  return {.period_s = kPeriod_s,
          .speed_rev_s = kSpeed_rev_s,
          .path_speed_mm_s = feed_per_tooth_mm * 2.0 * kSpeed_rev_s,
          .in_cut = true};
}

CuttingVibration::Cycle cut(CuttingVibration& vibration, const CuttingVibration::Input& input,
                            double seconds) {
  vibration.begin_cycle();
  for (double t = 0.0; t < seconds - 0.5 * input.period_s; t += input.period_s) {
    vibration.advance(input);
  }
  return vibration.cycle();
}

double unforced_um(const CuttingVibration::Cycle& c) {
  return 1000.0 * std::sqrt(c.unforced_mm2_s / c.cutting_s);
}

// Steps are even in angle, cycles in time: over half a second neither time nor samples may be
// lost.
TEST(CuttingVibration, KeepsTheMachinesTime) {
  auto vibration = CuttingVibration::make(benchmark_config(0.1)).value();
  const auto cycle = cut(vibration, cutting(), 0.5);
  EXPECT_NEAR(cycle.cutting_s, 0.5, 1e-4);
  EXPECT_NEAR(static_cast<double>(vibration.samples().size()), 0.5 * 10'000.0, 2.0);
  // Walls: a slot has one on the side of the entry angle, one point per tooth.
  EXPECT_NEAR(static_cast<double>(cycle.walls), 0.5 * 2.0 * kSpeed_rev_s, 2.0);
}

// 0.1 mm is below the border of 0.4086 mm, 1.0 mm above it: only regenerative vibration survives
// the difference over a tooth pass.
TEST(CuttingVibration, RepeatsFromToothToToothBelowTheBorderAndNotAbove) {
  auto stable = CuttingVibration::make(benchmark_config(0.1)).value();
  auto unstable = CuttingVibration::make(benchmark_config(1.0)).value();
  cut(stable, cutting(), 0.5);
  cut(unstable, cutting(), 0.5);
  const auto below = cut(stable, cutting(), 0.2);
  const auto above = cut(unstable, cutting(), 0.2);
  EXPECT_LT(unforced_um(below), 0.01);
  EXPECT_GT(unforced_um(above), 10.0);
  EXPECT_GT(above.force_peak_n, 5.0 * below.force_peak_n) << "ten times the depth, and chatter";
}

// Turning the feed by 90° must be the same as turning the mode by −90°.
TEST(CuttingVibration, AModeAcrossTheFeedIsAModeAlongAFeedThatIsTurned) {
  auto along_x = benchmark_config(0.1);
  auto along_y = along_x;
  along_y.cut.modes[0].shape = {0.0, 1.0};
  auto turned = CuttingVibration::make(along_x).value();
  auto across = CuttingVibration::make(along_y).value();
  auto input = cutting();
  const auto straight = cut(across, input, 0.2);
  input.feed_direction = {0.0, 1.0};
  const auto up = cut(turned, input, 0.2);
  ASSERT_GT(straight.peak_mm, 1e-4);
  EXPECT_DOUBLE_EQ(up.peak_mm, straight.peak_mm);
  EXPECT_DOUBLE_EQ(up.sum_mm_s[1], straight.sum_mm_s[1]);
  EXPECT_NEAR(up.sum_mm_s[0], 0.0, 1e-12) << "the mode does not move along that feed";
}

TEST(CuttingVibration, TheSensorHearsTheToothPassing) {
  auto vibration = CuttingVibration::make(benchmark_config(0.1)).value();
  cut(vibration, cutting(), 0.5);
  cut(vibration, cutting(), 0.3);
  // Goertzel's sums at the tooth's frequency and halfway to the next of its multiples.
  const auto amplitude = [&](double hz) {
    double c = 0.0;
    double s = 0.0;
    double t = 0.0;
    for (const double v : vibration.samples()) {
      const double w = 2.0 * std::numbers::pi * hz * t / vibration.sensor_rate_hz();
      c += v * std::cos(w);
      s += v * std::sin(w);
      t += 1.0;
    }
    return std::hypot(c, s) / t;
  };
  const double tooth_hz = 2.0 * kSpeed_rev_s;
  EXPECT_GT(amplitude(tooth_hz), 100.0 * amplitude(1.5 * tooth_hz));
}

// After 0.5 s in air e^−ζωt = e^−32 is left of 922 Hz.
TEST(CuttingVibration, OutOfTheCutTheToolRingsDownAndNothingIsCounted) {
  auto vibration = CuttingVibration::make(benchmark_config(1.0)).value();
  cut(vibration, cutting(), 0.5);
  auto air = cutting();
  air.in_cut = false;
  const auto first = cut(vibration, air, 0.002);
  const double loud = std::abs(vibration.samples()[5]);
  EXPECT_EQ(first.cutting_s, 0.0);
  cut(vibration, air, 0.5);
  EXPECT_LT(std::abs(vibration.samples().back()), 1e-6 * (loud + 1.0));
  air.speed_rev_s = 0.0;  // a stopped spindle stops no clock
  cut(vibration, air, 0.1);
  EXPECT_NEAR(static_cast<double>(vibration.samples().size()), 1000.0, 2.0);
}

TEST(CuttingVibration, TakesNoMemoryInTheCycle) {
  auto vibration = CuttingVibration::make(benchmark_config(1.0)).value();
  const kernel::rt::testing::AllocationGuard guard;
  cut(vibration, cutting(), 0.1);
}

TEST(CuttingVibration, RefusesASensorThatIsNone) {
  auto config = benchmark_config(1.0);
  config.sensor_rate_hz = 10.0;
  EXPECT_FALSE(CuttingVibration::make(config));
}

}  // namespace
}  // namespace steadyrest::sim
