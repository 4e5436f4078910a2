// SPDX-License-Identifier: Apache-2.0
#include <cmath>
#include <cstdint>
#include <functional>
#include <limits>

#include <gtest/gtest.h>

#include <steadyrest/kernel/rt/testing/allocation_guard.hpp>
#include <steadyrest/kernel/units/constants.hpp>
#include <steadyrest/supervisor/motion_stage.hpp>
#include <steadyrest/supervisor/supervisor.hpp>
#include <steadyrest/supervisor/test/bench.hpp>
#include <steadyrest/supervisor/test/encoder.hpp>

namespace steadyrest::supervisor {
namespace {

namespace machine = kernel::machine;
namespace signal = kernel::signal;
using kernel::units::kNan;
using test::kCount_mm;
using test::kCycle_s;
using test::Sine;
using test::two_axes;
using Change = std::function<void(signal::Frame&)>;

struct Rms {
  double velocity_mm_s = 0.0;
  double acceleration_mm_s2 = 0.0;
  // A bound that fails once is wrong, so it is counted from the first cycle on.
  int outside = 0;          ///< cycles in which a bound did not hold
  double bound_mm_s = 0.0;  ///< RMS where the axis moves by more than half of its speed
};

/// From 0.2 s to 3 s, six reversals at least.
Rms run(const machine::Machine& machine, const Change& change = [](signal::Frame&) {}) {
  auto stage = MotionStage::make(machine).value();
  Sine sine;
  Rms rms;
  int n = 0;
  int fast = 0;
  for (int i = 0; i < 3000; ++i) {
    signal::Frame frame = sine.next();
    change(frame);
    stage.update(frame, true);
    const auto& axis = frame.axis[0];
    const double v = std::abs(axis.velocity_mm_s - sine.velocity_mm_s);
    const double a = std::abs(axis.acceleration_mm_s2 - sine.acceleration_mm_s2);
    rms.outside += v > axis.velocity_bound_mm_s || a > axis.acceleration_bound_mm_s2;
    if (i >= 200) {
      ++n;
      rms.velocity_mm_s += v * v;
      rms.acceleration_mm_s2 += a * a;
      if (std::abs(sine.velocity_mm_s) > 6.0) {
        ++fast;
        rms.bound_mm_s += axis.velocity_bound_mm_s * axis.velocity_bound_mm_s;
      }
    }
  }
  rms.velocity_mm_s = std::sqrt(rms.velocity_mm_s / n);
  rms.acceleration_mm_s2 = std::sqrt(rms.acceleration_mm_s2 / n);
  rms.bound_mm_s = std::sqrt(rms.bound_mm_s / fast);
  return rms;
}

// What differencing the counts gives on this sine: 0.43 mm/s, 707 mm/s² (q/(√6·T), q/(√2·T²)).
TEST(MotionStage, SeesASineAHundredTimesFinerThanTheDifferenceOfItsCounts) {
  const Rms rms = run(two_axes());
  EXPECT_LT(rms.velocity_mm_s, 0.0043);
  EXPECT_LT(rms.acceleration_mm_s2, 7.07);
  EXPECT_EQ(rms.outside, 0);
  // Two edges and |a| ≤ A: 2·√(ε·A) at the best span, A·T for spans of one cycle.
  EXPECT_LT(rms.bound_mm_s, 0.158) << "a bound that says something";
  EXPECT_GT(rms.bound_mm_s, rms.velocity_mm_s);
}

// At most twice the errors: at a turn the sign of the counts says nothing for a cycle.
TEST(MotionStage, TakesTheDirectionFromTheCountsWhereTheControlDoesNotShowIt) {
  const Rms rms = run(two_axes(), [](signal::Frame& frame) { frame.axis[0].edge_direction = 0; });
  EXPECT_LT(rms.velocity_mm_s, 0.0086);
  EXPECT_LT(rms.acceleration_mm_s2, 14.0);
}

// Two ways to have no stamps: the machine file declares no clock, and the port sends stamps anyway
// (they must not be used) or not.
TEST(MotionStage, WithoutTimeStampsTheCountsAloneAreStillBetterThanTheirDifference) {
  auto machine = two_axes();
  machine.axes[0].encoder.clock_s = 0.0;
  for (const bool shown : {false, true}) {
    const Rms rms = run(machine, [&](signal::Frame& frame) {
      frame.axis[0].edge_s = shown ? frame.axis[0].edge_s : kNan;
    });
    EXPECT_LT(rms.velocity_mm_s, 0.43 / 3.0);
    EXPECT_LT(rms.acceleration_mm_s2, 707.0 / 20.0);
    EXPECT_GT(rms.velocity_mm_s, 0.0043) << "stamps of a machine that has none were used";
    EXPECT_EQ(rms.outside, 0);
  }
}

TEST(MotionStage, ARestoredStateGoesOnAsItWouldHave) {
  auto first = MotionStage::make(two_axes()).value();
  auto second = MotionStage::make(two_axes()).value();
  Sine sine;
  for (int i = 0; i < 2000; ++i) {
    auto frame = sine.next();
    auto again = frame;
    first.update(frame, true);
    if (i == 700) {
      second.restore(first.state());
    } else if (i > 700) {
      second.update(again, true);
      ASSERT_EQ(frame.axis[0].velocity_mm_s, again.axis[0].velocity_mm_s);
      ASSERT_EQ(frame.axis[0].acceleration_mm_s2, again.axis[0].acceleration_mm_s2);
      ASSERT_EQ(frame.axis[0].velocity_bound_mm_s, again.axis[0].velocity_bound_mm_s);
      ASSERT_EQ(frame.axis[0].acceleration_bound_mm_s2, again.axis[0].acceleration_bound_mm_s2);
    }
  }
}

// Stamps at infinity, in the future and before all time, every 50th cycle: each is dropped, so
// accuracy suffers for a cycle and the bound not at all.
TEST(MotionStage, GarbageFromTheCounterGivesNeitherNanNorABoundThatLies) {
  const Rms rms = run(two_axes(), [](signal::Frame& frame) {
    auto& axis = frame.axis[0];
    switch (frame.cycle % 50) {
      case 10:
        axis.edge_s = std::numeric_limits<double>::infinity();
        break;
      case 20:
        axis.edge_s = frame.time_s + 1.0;
        break;
      case 30:
        axis.edge_s = -1e300;
        break;
      default:
        break;
    }
  });
  EXPECT_LT(rms.velocity_mm_s, 0.1);
  EXPECT_EQ(rms.outside, 0);
  auto stage = MotionStage::make(two_axes()).value();
  signal::Frame frame;
  for (const auto count : {std::numeric_limits<std::int64_t>::max(),
                           std::numeric_limits<std::int64_t>::min(), std::int64_t{0}}) {
    frame.time_s += kCycle_s;
    frame.axis[0] = {.encoder_shown = true, .count = count, .edge_s = frame.time_s};
    stage.update(frame, true);
    EXPECT_TRUE(std::isfinite(frame.axis[0].velocity_mm_s));
  }
}

// Two counts of line error: any line could be its neighbour, so nothing is provable.
TEST(MotionStage, LinesThatErrByMoreThanACountLeaveNoBound) {
  auto machine = two_axes();
  machine.axes[0].encoder.line_error_au = 2.0 * kCount_mm;
  auto stage = MotionStage::make(machine).value();
  Sine sine;
  for (int i = 0; i < 500; ++i) {
    auto frame = sine.next();
    stage.update(frame, true);
    EXPECT_EQ(frame.axis[0].velocity_bound_mm_s, motion::online::kNoBound);
    EXPECT_EQ(frame.axis[0].acceleration_bound_mm_s2, motion::online::kNoBound);
  }
}

TEST(MotionStage, ACycleAllocatesNothing) {
  auto stage = MotionStage::make(two_axes()).value();
  Sine sine;
  const kernel::rt::testing::AllocationGuard guard;
  for (int i = 0; i < 500; ++i) {
    auto frame = sine.next();
    frame.axis[0].count += i == 250 ? 1'000'000 : 0;
    stage.update(frame, i % 10 != 0);
  }
}

}  // namespace
}  // namespace steadyrest::supervisor
