// SPDX-License-Identifier: Apache-2.0
#include <cmath>
#include <cstdint>
#include <functional>
#include <limits>
#include <numbers>
#include <vector>

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
using test::kClock_s;
using test::kCount_mm;
using test::kCycle_s;
using test::kRate_1_s;

constexpr double kAmplitude_mm = 1.0;

/// Two axes; the limits are those of the sine below.
machine::Machine two_axes() {
  machine::Machine machine;
  machine.axes.resize(2);
  for (auto& axis : machine.axes) {
    axis.encoder.count_mm = kCount_mm;
    axis.max_speed_mm_s = kAmplitude_mm * kRate_1_s;
    axis.max_acceleration_mm_s2 = axis.max_speed_mm_s * kRate_1_s;
    axis.max_jerk_mm_s3 = axis.max_acceleration_mm_s2 * kRate_1_s;
  }
  return machine;
}

/// x = A·(1 − cos ωt), 2 Hz, and what a latching counter shows of it by the closed form.
class Sine {
 public:
  signal::Frame next() {
    signal::Frame frame;
    frame.axis_count = 2;
    frame.cycle = ++cycle_;
    frame.time_s = static_cast<double>(cycle_) * kCycle_s;
    const double phase = std::fmod(kRate_1_s * frame.time_s, 2.0 * std::numbers::pi);
    const bool rises = phase < std::numbers::pi;
    const double x = kAmplitude_mm * (1.0 - std::cos(phase));
    const auto count = static_cast<std::int64_t>(std::floor(x / kCount_mm + 0.5));
    // Way up: the line below was passed last. Just after the top none has been passed on the way
    // down: the last one is that below too, on the way up.
    const double top = std::floor(2.0 * kAmplitude_mm / kCount_mm + 0.5);
    const bool up = rises ? count > 0 : static_cast<double>(count) == top;
    const double line = static_cast<double>(count) + (up ? -0.5 : 0.5);
    const double at = std::acos(1.0 - line * kCount_mm / kAmplitude_mm);
    const double line_phase = up ? at : 2.0 * std::numbers::pi - at;
    double edge_s = frame.time_s - (phase - line_phase) / kRate_1_s;
    edge_s -= edge_s > frame.time_s ? 2.0 * std::numbers::pi / kRate_1_s : 0.0;
    velocity_mm_s = kAmplitude_mm * kRate_1_s * std::sin(phase);
    acceleration_mm_s2 = kAmplitude_mm * kRate_1_s * kRate_1_s * std::cos(phase);
    auto& axis = frame.axis[0];
    axis.actual_mm = axis.command_mm = static_cast<double>(count) * kCount_mm;
    axis.encoder_shown = true;
    axis.count = count;
    axis.edge_s = edge_s > 0.0 ? std::floor(edge_s / kClock_s) * kClock_s : kNan;
    axis.edge_direction = up ? std::int8_t{1} : std::int8_t{-1};
    return frame;
  }

  double velocity_mm_s = 0.0;
  double acceleration_mm_s2 = 0.0;

 private:
  std::uint64_t cycle_ = 0;
};

struct Rms {
  double velocity_mm_s = 0.0;
  double acceleration_mm_s2 = 0.0;
  // A bound that fails once is wrong, so it is counted from the first cycle on.
  int outside = 0;          ///< cycles in which a bound did not hold
  double bound_mm_s = 0.0;  ///< RMS where the axis moves by more than half of its speed
};

using Change = std::function<void(signal::Frame&)>;

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

// What the difference of the counts gives on this sine: 0.43 mm/s, 707 mm/s² (q/(√6·T), q/(√2·T²)).
TEST(MotionStage, SeesASineAHundredTimesFinerThanTheDifferenceOfItsCounts) {
  const Rms rms = run(two_axes());
  EXPECT_LT(rms.velocity_mm_s, 0.0043);
  EXPECT_LT(rms.acceleration_mm_s2, 7.07);
  EXPECT_EQ(rms.outside, 0);
  // Two edges and |a| ≤ A: 2·√(ε·A) at the best span, A·T for spans of one cycle.
  EXPECT_LT(rms.bound_mm_s, 0.158) << "a bound that says something";
  EXPECT_GT(rms.bound_mm_s, rms.velocity_mm_s);
}

// Twice the errors at most: at a turn the sign of the counts says nothing for a cycle.
TEST(MotionStage, TakesTheDirectionFromTheCountsWhereTheControlDoesNotShowIt) {
  const Rms rms = run(two_axes(), [](signal::Frame& frame) { frame.axis[0].edge_direction = 0; });
  EXPECT_LT(rms.velocity_mm_s, 0.0086);
  EXPECT_LT(rms.acceleration_mm_s2, 14.0);
}

// Two ways to have no stamps: the machine file says that there is no clock, with the port showing
// stamps all the same (they must not be used) or not.
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

void expect_none(const signal::AxisSample& axis) {
  EXPECT_EQ(axis.velocity_mm_s, 0.0);
  EXPECT_EQ(axis.acceleration_mm_s2, 0.0);
  EXPECT_EQ(axis.velocity_bound_mm_s, motion::online::kNoBound);
  EXPECT_EQ(axis.acceleration_bound_mm_s2, motion::online::kNoBound);
}

TEST(MotionStage, GivesNoEstimateWithoutAnEncoder) {
  auto ideal = two_axes();
  ideal.axes[0].encoder.count_mm = 0.0;
  auto absent = two_axes();
  absent.axes[0].present = false;
  for (const auto& machine : {ideal, absent}) {
    auto stage = MotionStage::make(machine).value();
    Sine sine;
    for (int i = 0; i < 50; ++i) {
      auto frame = sine.next();
      frame.axis[0].velocity_mm_s = 7.0;  // nobody else's estimate is passed on
      stage.update(frame, true);
      expect_none(frame.axis[0]);
    }
  }
  auto stage = MotionStage::make(two_axes()).value();
  Sine sine;
  for (int i = 0; i < 50; ++i) {
    auto frame = sine.next();
    stage.update(frame, true);
    if (i > 10) {
      EXPECT_LT(frame.axis[0].velocity_bound_mm_s, 13.0);
    }
    expect_none(frame.axis[1]);  // its counter is not shown
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

TEST(MotionStage, GivesNoneForAFrameThatIsUnfitAndGoesOnAfterIt) {
  auto stage = MotionStage::make(two_axes()).value();
  Sine sine;
  for (int i = 0; i < 1000; ++i) {
    auto frame = sine.next();
    const bool fit = i % 100 != 99;
    const bool finite = i % 100 != 49;
    frame.time_s = finite ? frame.time_s : kNan;
    stage.update(frame, fit);
    if (!fit || !finite) {
      expect_none(frame.axis[0]);
    } else if (i > 200) {
      ASSERT_NEAR(frame.axis[0].velocity_mm_s, sine.velocity_mm_s, 0.1) << i;
    }
  }
}

// Counter set, time forwards, time back, counter not shown for one cycle. The bound must hold
// throughout: only a restart can do that, since before and after do not fit one motion.
TEST(MotionStage, StartsAnewWhereTheCounterWasSetOrTheRecordHasAHole) {
  const std::vector<Change> faults = {
      [](signal::Frame& frame) {
        if (frame.cycle >= 500) {
          frame.axis[0].count += 1'000'000;
        }
      },
      [](signal::Frame& frame) {
        if (frame.cycle >= 500) {
          frame.time_s += 100.0;
          frame.axis[0].edge_s += 100.0;
        }
      },
      [](signal::Frame& frame) {
        if (frame.cycle >= 500) {
          frame.time_s -= 0.4;
          frame.axis[0].edge_s -= 0.4;
        }
      },
      [](signal::Frame& frame) { frame.axis[0].encoder_shown = frame.cycle != 500; },
  };
  for (const auto& fault : faults) {
    auto stage = MotionStage::make(two_axes()).value();
    Sine sine;
    for (int i = 0; i < 800; ++i) {
      auto frame = sine.next();
      fault(frame);
      stage.update(frame, true);
      const auto& axis = frame.axis[0];
      ASSERT_LE(std::abs(axis.velocity_mm_s - sine.velocity_mm_s), axis.velocity_bound_mm_s) << i;
      if (i > 520) {
        ASSERT_NEAR(axis.velocity_mm_s, sine.velocity_mm_s, 0.1) << i;
      }
    }
  }
}

// The same count and stamp again are no news; taken as a measurement they would narrow the
// estimate and shift it.
TEST(MotionStage, ASampleThatIsShownTwiceIsNotTwiceTheEvidence) {
  auto stage = MotionStage::make(two_axes()).value();
  auto twice = MotionStage::make(two_axes()).value();
  Sine sine;
  for (int i = 0; i < 300; ++i) {
    auto frame = sine.next();
    auto same = frame;
    stage.update(frame, true);
    twice.update(same, true);
    twice.update(same, true);
    ASSERT_EQ(frame.axis[0].velocity_mm_s, same.axis[0].velocity_mm_s);
    ASSERT_EQ(frame.axis[0].velocity_bound_mm_s, same.axis[0].velocity_bound_mm_s);
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

// Two counts of line error: each line could be its neighbour, nothing is provable.
TEST(MotionStage, LinesThatErrByMoreThanACountLeaveNoBound) {
  auto machine = two_axes();
  machine.axes[0].encoder.line_error_mm = 2.0 * kCount_mm;
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

// Half a cycle later without a frame: the old count must not pass for a new one.
TEST(MotionStage, TheSupervisorHasTheEstimatesInTheFrameThatItDecidesBy) {
  auto supervisor = Supervisor::make(two_axes(), {}).value();
  Sine sine;
  for (int i = 0; i < 500; ++i) {
    const auto frame = sine.next();
    supervisor.update(frame);
    if (i % 50 == 49) {  // nothing could be read for a cycle: the old count says nothing of now
      supervisor.update_without_frame(frame.time_s + 0.5 * kCycle_s);
      expect_none(supervisor.frame().axis[0]);
    } else if (i > 200) {
      ASSERT_NEAR(supervisor.frame().axis[0].velocity_mm_s, sine.velocity_mm_s, 0.05) << i;
    }
  }
  supervisor.restore(supervisor.state());
  supervisor.update(sine.next());
  EXPECT_GT(supervisor.frame().axis[0].velocity_bound_mm_s, 1.0) << "the estimates start anew";
}

}  // namespace
}  // namespace steadyrest::supervisor
