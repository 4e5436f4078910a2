// SPDX-License-Identifier: Apache-2.0
// What the estimator must withstand; motion_targets_test.cpp tests its accuracy.
#include <cmath>
#include <limits>

#include <gtest/gtest.h>

#include <steadyrest/kernel/rt/testing/allocation_guard.hpp>
#include <steadyrest/motion/offline/test/scenes.hpp>
#include <steadyrest/motion/online/bounded/motion_estimator.hpp>

namespace steadyrest::motion::offline::test {
namespace {

using online::MotionEstimator;

MotionEstimator made(const MotionEstimator::Config& config) {
  return MotionEstimator::make(config).value();
}

// Two seconds without an edge: standstill must win against the four moving models.
TEST(MotionEstimator, StandsStillWhereNothingHappens) {
  MotionEstimator e = made({});
  Estimate last;
  for (int k = 0; k < 2000; ++k) {
    last = e.tick({0.001 * k, 7, 0.007, 0.008});
  }
  EXPECT_NEAR(last.velocity_mm_s, 0.0, 1e-6);
  EXPECT_NEAR(last.acceleration_mm_s2, 0.0, 1e-3);
  EXPECT_GT(e.standstill(), 0.99);
}

TEST(MotionEstimator, DitherOnALineStaysSmall) {
  // 0.3 µm at 20 Hz over one line: speed up to 0.038 mm/s, one edge in 25 ms.
  const Record record = offline::record(dither(0.0003, 20.0, 2.0), {});
  MotionEstimator e = made({});
  const Score s = score(run(e, record), record, 0.0, 0.1);
  EXPECT_LT(s.velocity_rms_mm_s, 0.05);
  EXPECT_LT(s.velocity_max_mm_s, 0.2);
}

// Edges have their own stamps: the time of the look must not matter.
TEST(MotionEstimator, DoesNotCareWhenTheCycleJitters) {
  Recording how;
  const Record steady = offline::record(sine(1.0, 2.0, 2.0), how);
  how.tick_jitter_s = 1e-4;
  const Record jittery = offline::record(sine(1.0, 2.0, 2.0), how);
  MotionEstimator a = made({});
  MotionEstimator b = made({});
  const Score calm = score(run(a, steady), steady, 0.0, 0.02);
  const Score shaken = score(run(b, jittery), jittery, 0.0, 0.02);
  EXPECT_LT(shaken.velocity_rms_mm_s, 1.2 * calm.velocity_rms_mm_s);
  EXPECT_LT(shaken.acceleration_rms_mm_s2, 1.2 * calm.acceleration_rms_mm_s2);
}

// 5 % lost at random, then half a second missing entirely; 30 ms after the gap it must be as good
// as before.
TEST(MotionEstimator, GoesOnAfterLostEdgesAndAGap) {
  Recording how;
  how.lost_share = 0.05;
  Record record = offline::record(sine(1.0, 2.0, 2.0), how);
  MotionEstimator e = made({});
  EXPECT_LT(score(run(e, record), record, 0.0, 0.02).velocity_rms_mm_s, 0.002);

  // Half a second is missing.
  std::erase_if(record.edges, [](const Edge& edge) { return edge.t_s > 0.7 && edge.t_s < 1.2; });
  Record holed = record;
  holed.ticks.clear();
  holed.truth.clear();
  for (std::size_t k = 0; k < record.ticks.size(); ++k) {
    if (record.ticks[k].t_s < 0.7 || record.ticks[k].t_s > 1.2) {
      holed.ticks.push_back(record.ticks[k]);
      holed.truth.push_back(record.truth[k]);
    }
  }
  MotionEstimator f = made({});
  EXPECT_LT(score(run(f, holed), holed, 0.0, 1.23).velocity_rms_mm_s, 0.003);
}

// Everything is in counts internally: the same motion in counts of 64 µm must have 64 times the
// error.
TEST(MotionEstimator, CountsOfAnyLengthAreAlike) {
  Recording how;
  how.count_mm = 0.064;
  const Profile coarse = sine(64.0, 2.0, 1.0);
  const Record big = offline::record(coarse, how);
  const Record small = offline::record(sine(1.0, 2.0, 1.0), {});
  MotionEstimator::Config config;
  config.count_mm = 0.064;
  MotionEstimator a = made(config);
  MotionEstimator b = made({});
  const Score of_big = score(run(a, big), big, 0.0, 0.02);
  const Score of_small = score(run(b, small), small, 0.0, 0.02);
  EXPECT_NEAR(of_big.velocity_rms_mm_s / of_small.velocity_rms_mm_s, 64.0, 0.5);
  EXPECT_NEAR(of_big.acceleration_rms_mm_s2 / of_small.acceleration_rms_mm_s2, 64.0, 0.5);
}

// The bound from counts alone is 0.25 mm/s at best; the estimate itself can be better.
TEST(MotionEstimator, WorksFromSampledCountsAlone) {
  const Record record = without_edges(sine_ideal());
  MotionEstimator e = made({.max_acceleration_mm_s2 = 160.0, .max_jerk_mm_s3 = 2000.0});
  const Score s = score(run(e, record), record, 0.0, 0.05);
  EXPECT_LT(s.velocity_rms_mm_s,
            0.13);  // difference 0.43, Savitzky–Golay over 16 samples 0.06 … 0.07
  EXPECT_LT(s.acceleration_rms_mm_s2, 25.0);
  EXPECT_EQ(s.velocity_coverage, 1.0);
  EXPECT_EQ(s.acceleration_coverage, 1.0);
}

// Later estimates know more: each lag must pay.
TEST(MotionEstimator, ALagBuysAccuracyAndSaysForWhichInstant) {
  double last_v = 1.0;
  for (const double lag_s : {0.0, 0.002, 0.008}) {
    MotionEstimator e = made({.max_jerk_mm_s3 = 2000.0, .lag_s = lag_s});
    const auto estimates = run(e, sine_ideal());
    EXPECT_NEAR(estimates[500].t_s, sine_ideal().ticks[500].t_s - lag_s, 1e-9);
    const Score s = score(estimates, sine_ideal(), lag_s, 0.04);
    EXPECT_LT(s.velocity_rms_mm_s, 0.65 * last_v) << lag_s;
    EXPECT_EQ(s.velocity_coverage, 1.0);
    EXPECT_EQ(s.acceleration_coverage, 1.0);
    last_v = s.velocity_rms_mm_s;
  }
}

// A twin without the bad input must give the same numbers.
TEST(MotionEstimator, UnfitInputIsCountedAndDoesNoHarm) {
  const double nan = std::numeric_limits<double>::quiet_NaN();
  MotionEstimator e = made({});
  MotionEstimator clean = made({});
  std::size_t at = 0;
  for (const Tick& tick : sine_ideal().ticks) {
    for (; at < sine_ideal().edges.size() && sine_ideal().edges[at].t_s <= tick.t_s; ++at) {
      e.edge(sine_ideal().edges[at]);
      clean.edge(sine_ideal().edges[at]);
      e.edge({nan, 0.0, 0, 1, 0});
      e.edge({tick.t_s - 5.0, 0.0, 0, 1, 0});
    }
    EXPECT_TRUE(std::isfinite(e.tick({tick.t_s, tick.count, nan, nan}).velocity_mm_s));
    EXPECT_EQ(e.tick(tick).velocity_mm_s, clean.tick(tick).velocity_mm_s);
  }
  EXPECT_GT(e.rejected(), sine_ideal().ticks.size());
}

TEST(MotionEstimator, DoesNotAllocate) {
  MotionEstimator e = made({.max_jerk_mm_s3 = 5000.0, .lag_s = 0.004});
  const Record& record = s_curve_ideal();
  std::size_t at = 0;
  const kernel::rt::testing::AllocationGuard guard;
  for (const Tick& tick : record.ticks) {
    for (; at < record.edges.size() && record.edges[at].t_s <= tick.t_s; ++at) {
      e.edge(record.edges[at]);
    }
    e.tick(tick);
  }
  EXPECT_EQ(guard.allocations(), 0U);
}

TEST(MotionEstimator, RefusesWhatMakesNoSense) {
  EXPECT_FALSE(MotionEstimator::make({.count_mm = 0.0}));
  EXPECT_FALSE(MotionEstimator::make({.count_mm = 0.001, .line_error_mm = 0.002}));
  EXPECT_FALSE(MotionEstimator::make({.cycle_s = 0.0}));
  EXPECT_FALSE(MotionEstimator::make({.max_jerk_mm_s3 = -1.0}));
  EXPECT_FALSE(MotionEstimator::make({.lag_s = 0.1}));
}

}  // namespace
}  // namespace steadyrest::motion::offline::test
