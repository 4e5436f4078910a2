// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <cmath>
#include <random>

#include <gtest/gtest.h>

#include <steadyrest/motion/offline/test/scenes.hpp>
#include <steadyrest/motion/online/estimator/event_fit.hpp>
#include <steadyrest/motion/online/estimator/savitzky_golay.hpp>

namespace steadyrest::motion::offline::test {
namespace {

using online::EventFit;

Recording exact_stamps() {
  Recording how;
  how.clock_s = 0.0;
  return how;
}

Score moving(const EventFit::Config& config, const Record& record, double min_speed_mm_s = 1.0) {
  EventFit estimator = EventFit::make(config).value();
  return offline::score(offline::run(estimator, record), record, 0.0, 0.02, min_speed_mm_s);
}

// A polynomial of the fit's degree is fitted exactly; the rest is the 10⁻¹³ s of the edges. A
// parabola must not fit a cubic, or the test would show nothing.
TEST(EventFit, IsExactOnPolynomialsOfItsDegree) {
  const Record parabola = offline::record(ramp(2.0, 30.0, 0.5), exact_stamps());
  for (const std::size_t degree : {2U, 3U}) {
    const Score s = scored<EventFit>({.degree = degree}, parabola, 0.0, 0.05);
    EXPECT_LT(s.velocity_max_mm_s, 1e-6) << degree;  // edges are found within 1e-13 s
    EXPECT_LT(s.acceleration_max_mm_s2, 1e-2) << degree;
  }
  const Profile cubic = jerk_pieces("cubic", {0.0002, 2.0, 10.0}, {{0.3, 200.0}});
  const Record record = offline::record(cubic, exact_stamps());
  EXPECT_LT(scored<EventFit>({.degree = 3}, record, 0.0, 0.05).velocity_max_mm_s, 1e-6);
  EXPECT_GT(scored<EventFit>({.degree = 2}, record, 0.0, 0.05).velocity_max_mm_s, 1e-5);
}

TEST(EventFit, JerkBiasesTheEndOfAParabolaAsTheReferenceSays) {
  // −J·W²/10 and −J·W/2: W = 8 ms at 20 mm/s, 160 edges.
  const Record record =
      offline::record(jerk_pieces("cubic", {0.0002, 20.0, 0.0}, {{0.1, 1000.0}}), exact_stamps());
  EventFit estimator = EventFit::make({.edges = 512, .window_s = 0.008}).value();
  const auto estimates = offline::run(estimator, record);
  const double v_bias = mean_velocity_error(estimates, record, 0.02);
  EXPECT_NEAR(v_bias, -1000.0 * 0.008 * 0.008 / 10.0, 0.05 * 0.0064);
  EXPECT_NEAR(scored<EventFit>({.edges = 512, .window_s = 0.008}, record).acceleration_rms_mm_s2,
              1000.0 * 0.008 / 2.0, 0.05 * 4.0);
}

TEST(EventFit, HasNoBiasAtTheDelaysOfTheReference) {
  // p = 2: v at W/2·(1 − 1/√5) and a at W/2 before the end are free of the jerk's bias. The newest
  // edge is 25 µs old on average; the delays, like W, count from it.
  const Record record =
      offline::record(jerk_pieces("cubic", {0.0002, 20.0, 0.0}, {{0.1, 1000.0}}), exact_stamps());
  EventFit estimator = EventFit::make({.edges = 512, .window_s = 0.008}).value();
  const auto estimates = offline::run(estimator, record);
  double worst_v = 0.0;
  double worst_a = 0.0;
  for (std::size_t k = 20; k < estimates.size(); ++k) {
    const double v_delay = 0.004 * (1.0 - 1.0 / std::sqrt(5.0));
    const double then_v =
        estimates[k].velocity_mm_s - estimates[k].acceleration_mm_s2 * v_delay;  // of the parabola
    const MotionState v_truth = motion_of(record, k, v_delay);
    const MotionState a_truth = motion_of(record, k, 0.004);
    worst_v = std::max(worst_v, std::abs(then_v - v_truth.velocity_mm_s));
    worst_a =
        std::max(worst_a, std::abs(estimates[k].acceleration_mm_s2 - a_truth.acceleration_mm_s2));
  }
  EXPECT_LT(worst_v, 0.06 * 0.0064);  // against the bias at the end
  EXPECT_LT(worst_a, 0.03 * 4.0);
}

// Least squares of a parabola at its end point: variances 192·σ²/(N·W²) and 720·σ²/(N·W⁴).
TEST(EventFit, LineErrorsActByTheClosedFormOfTheEndPoint) {
  // Evenly spaced edges are samples: variance = σ²·Σ weights², which tends to 192·σ²/(N·W²).
  Recording how = exact_stamps();
  how.line_error_counts = 0.02;
  const Record record = offline::record(offline::constant_speed(20.0, 4.0), how);
  const Score s = scored<EventFit>({.edges = 80}, record, 0.0, 0.02);
  const double sigma = 0.02 * 0.001;
  const double window = 80 * 0.001 / 20.0;
  const double closed_v = std::sqrt(192.0 / 80.0) * sigma / window;
  const double closed_a = std::sqrt(720.0 / 80.0) * sigma / (window * window);
  EXPECT_NEAR(s.velocity_rms_mm_s, closed_v, 0.12 * closed_v);
  EXPECT_NEAR(s.acceleration_rms_mm_s2, closed_a, 0.12 * closed_a);
}

// The reference's own simulation, another program: the figures must agree to 10 %.
TEST(EventFit, GivesTheTableOfTheReferenceWhereTheAxisMoves) {
  // Rows "event LSQ2 W=4 ms" and "W=8 ms", |v| > 1 mm/s, ±10 %.
  const EventFit::Config w4{.edges = 512, .window_s = 0.004};
  const EventFit::Config w8{.edges = 512, .window_s = 0.008};
  const Score s4 = moving(w4, sine_ideal());
  EXPECT_NEAR(s4.velocity_rms_mm_s, 0.0023, 0.00023);
  EXPECT_NEAR(s4.acceleration_rms_mm_s2, 2.84, 0.28);
  const Score s8 = moving(w8, sine_ideal());
  EXPECT_NEAR(s8.velocity_rms_mm_s, 0.0091, 0.00091);
  EXPECT_NEAR(s8.acceleration_rms_mm_s2, 5.7, 0.57);
}

TEST(EventFit, LineErrorsCostWhatTheTheorySaysOverTheSine) {
  // Noise 192·σ²/(N·W²), N = |v|·W/q, and the bias J·W²/10, tick by tick, |v| > 3 mm/s (the theory
  // takes v as constant over W; it changes by up to 1.3 mm/s). The lines of the scene: pattern of 5
  // % (RMS 0.778 of it) and 2 % at random; the pattern averages out over its four lines, so the
  // theory with both is an upper bound and with only the random part a lower one.
  for (const double window : {0.004, 0.008}) {
    const Record& record = sine_line_errors();
    const Score s = moving({.edges = 512, .window_s = window}, record, 3.0);
    double low = 0.0;
    double high = 0.0;
    double n = 0.0;
    for (const MotionState& m : record.truth) {
      const double v = std::abs(m.velocity_mm_s);
      if (v < 3.0) {
        continue;
      }
      const double jerk = v * std::pow(2.0 * 3.14159265358979 * 2.0, 2.0);
      const double bias2 = std::pow(jerk * window * window / 10.0, 2.0);
      const double per_variance = 192.0 / (v * window / 0.001 * window * window);
      low += bias2 + per_variance * std::pow(0.02e-3, 2.0);
      high += bias2 + per_variance * (std::pow(0.02e-3, 2.0) + std::pow(0.0389e-3, 2.0));
      n += 1.0;
    }
    EXPECT_GT(s.velocity_rms_mm_s, std::sqrt(low / n)) << window;
    EXPECT_LT(s.velocity_rms_mm_s, 1.2 * std::sqrt(high / n)) << window;
  }
}

// A stale fit extrapolates through every stop; the cell since the last edge ends that.
TEST(EventFit, TheClipHoldsItThroughStartStopAndReversal) {
  // Without it the reference has 0.145 over the whole S-curve.
  const Score s = scored<EventFit>({.edges = 512, .window_s = 0.004}, s_curve_ideal());
  EXPECT_NEAR(s.velocity_rms_mm_s, 0.026, 0.004);
  EXPECT_LT(s.velocity_max_mm_s, 0.5);
}

// Every fourth edge has the same phase, so its error is constant and drops out.
TEST(EventFit, SkippingToOnePhaseIsDeafToThePhaseError) {
  Recording how = exact_stamps();
  how.phase_error_counts = 0.05;
  const Record record = offline::record(offline::constant_speed(9.7, 1.0), how);
  const double with_skip =
      scored<EventFit>({.edges = 8, .skip = 3}, record, 0.0, 0.1).velocity_rms_mm_s;
  const double without =
      scored<EventFit>({.edges = 8, .skip = 0}, record, 0.0, 0.1).velocity_rms_mm_s;
  EXPECT_LT(with_skip, 1e-6);
  EXPECT_GT(without, 0.01);
}

// No edge since: |v| ≤ (cell + line error)/age, 0.00125 mm here, and 0 after the timeout.
TEST(EventFit, FallsAsTheAgeOfTheLastEdgeAndRestsAfterTheTimeout) {
  EventFit estimator = EventFit::make({}).value();
  for (int k = 1; k <= 20; ++k) {
    estimator.edge({k * 0.0001, k * 0.001, k, 1, 0});
  }
  for (int k = 3; k < 600; ++k) {
    const Estimate e = estimator.tick({k * 0.001, 20, 0.020, 0.021});
    const double age = k * 0.001 - 0.002;
    EXPECT_LE(e.velocity_mm_s, 0.00125 / age + 1e-12) << k;
    EXPECT_EQ(e.velocity_mm_s == 0.0, age >= 0.5 - 1e-12) << k;
  }
}

TEST(EventFit, RefusesWhatCannotWork) {
  EXPECT_FALSE(EventFit::make({.degree = 0}).has_value());
  EXPECT_FALSE(EventFit::make({.degree = 4}).has_value());
  EXPECT_FALSE(EventFit::make({.degree = 3, .edges = 3}).has_value());
  EXPECT_FALSE(EventFit::make({.edges = 200, .skip = 3}).has_value());
  EXPECT_FALSE(EventFit::make({.window_s = -1.0}).has_value());
  EXPECT_FALSE(EventFit::make({.count_mm = 0.0}).has_value());
  EXPECT_FALSE(EventFit::make({.timeout_s = std::nan("")}).has_value());
}

}  // namespace
}  // namespace steadyrest::motion::offline::test
