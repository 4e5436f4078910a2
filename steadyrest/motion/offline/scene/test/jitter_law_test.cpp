// SPDX-License-Identifier: Apache-2.0
#include <array>
#include <cmath>
#include <cstdint>
#include <numbers>

#include <gtest/gtest.h>

#include <steadyrest/motion/offline/scene/scene.hpp>
#include <steadyrest/motion/online/edges/cycle_monitor.hpp>

namespace steadyrest::motion::offline {
namespace {

using online::acceleration_jitter_error_mm_s2;
using online::velocity_jitter_error_mm_s;

struct DifferenceError {
  double velocity_mm_s = 0.0;
  double acceleration_mm_s2 = 0.0;
};

/// RMS error of differences over the nominal period, without bias, against the scene's truth.
DifferenceError difference_errors(const Record& record, bool counts) {
  const double period_s = 1.0 / record.how.cycle_hz;
  const auto x = [&](std::size_t k) {
    return counts ? static_cast<double>(record.ticks[k].count) * record.how.count_mm
                  : record.truth[k].position_mm;
  };
  std::array<double, 2> sum{};
  std::array<double, 2> squares{};
  double n = 0.0;
  for (std::size_t k = 3; k + 1 < record.ticks.size(); ++k, n += 1.0) {
    const double v = (x(k) - x(k - 1)) / period_s - record.truth[k].velocity_mm_s;
    const double a = (x(k) - 2.0 * x(k - 1) + x(k - 2)) / (period_s * period_s) -
                     record.truth[k].acceleration_mm_s2;
    sum[0] += v;
    sum[1] += a;
    squares[0] += v * v;
    squares[1] += a * a;
  }
  const auto rms = [n](double total, double square) {
    return std::sqrt(square / n - total / n * (total / n));
  };
  return {rms(sum[0], squares[0]), rms(sum[1], squares[1])};
}

TEST(JitterLaw, TheErrorOfDifferencesIsTheFormulasInSimulation) {
  for (const double speed : {2.0, 20.0, 100.0}) {
    for (const double jitter : {1e-6, 20e-6}) {
      const Record record =
          offline::record(constant_speed(speed, 8.0), {.count_mm = 0.01, .tick_jitter_s = jitter});
      const DifferenceError error = difference_errors(record, false);
      const double v = velocity_jitter_error_mm_s(speed, 0.0, 1e-3, jitter);
      const double a = acceleration_jitter_error_mm_s2(speed, 1e-3, jitter);
      EXPECT_NEAR(error.velocity_mm_s, v, 0.03 * v) << speed << " mm/s, " << jitter << " s";
      EXPECT_NEAR(error.acceleration_mm_s2, a, 0.03 * a) << speed << " mm/s, " << jitter << " s";
    }
  }
}

TEST(JitterLaw, AccelerationTakesItsShareFromTheSpeed) {
  // From 0.5 mm/s at 1000 mm/s²: v/T equals a at 1 mm/s, so the error must nearly vanish there.
  const auto profile = jerk_pieces("ramp", {0.0, 0.5, 1000.0}, {{2e-3, 0.0}});
  constexpr double kJitter = 5e-6;
  double squares = 0.0;
  double expected = 0.0;
  double beside = 0.0;
  constexpr int kRuns = 1500;
  for (int seed = 1; seed <= kRuns; ++seed) {
    const Record record = offline::record(
        profile,
        {.count_mm = 0.01, .tick_jitter_s = kJitter, .seed = static_cast<std::uint64_t>(seed)});
    const double v_hat = (record.truth[1].position_mm - record.truth[0].position_mm) / 1e-3;
    // Tick 0 cannot lie before the motion starts: its jitter is the positive half.
    const double j0 = record.ticks[0].t_s;
    const double j1 = record.ticks[1].t_s - 1e-3;
    const double error = v_hat - record.truth[1].velocity_mm_s + 0.5;
    const double law = (1.5 / 1e-3 - 1000.0) * (j1 - j0);
    squares += error * error;
    expected += law * law;
    beside += (error - law) * (error - law);
  }
  EXPECT_NEAR(std::sqrt(squares / kRuns), std::sqrt(expected / kRuns),
              0.01 * std::sqrt(expected / kRuns));
  EXPECT_LT(std::sqrt(beside / kRuns), 0.02 * std::sqrt(expected / kRuns));
  EXPECT_DOUBLE_EQ(velocity_jitter_error_mm_s(1.0, 1000.0, 1e-3, kJitter), 0.0);
  EXPECT_DOUBLE_EQ(velocity_jitter_error_mm_s(1.5, 1000.0, 1e-3, kJitter),
                   std::numbers::sqrt2 * kJitter * 500.0);
}

TEST(JitterLaw, QuantisationAddsAsTheRootOfTheSumOfSquares) {
  // A speed whose counts per tick are not a simple fraction: the mean over phases is q²/6 … as f(1
  // − f).
  constexpr double kSpeed = 21.61803398875;
  const Record record =
      offline::record(constant_speed(kSpeed, 8.0), {.count_mm = 0.001, .tick_jitter_s = 20e-6});
  const DifferenceError error = difference_errors(record, true);
  const double jitter = velocity_jitter_error_mm_s(kSpeed, 0.0, 1e-3, 20e-6);
  const double both = std::hypot(jitter, 0.001 / (std::sqrt(6.0) * 1e-3));
  EXPECT_NEAR(error.velocity_mm_s, both, 0.03 * both);
  EXPECT_GT(error.velocity_mm_s, 1.08 * jitter);
}

}  // namespace
}  // namespace steadyrest::motion::offline
