// SPDX-License-Identifier: Apache-2.0
#include <cmath>
#include <functional>
#include <vector>

#include <gtest/gtest.h>

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
using test::kCycle_s;
using test::Sine;
using test::two_axes;
using Change = std::function<void(signal::Frame&)>;

void expect_none(const signal::AxisSample& axis) {
  EXPECT_EQ(axis.velocity_mm_s, 0.0);
  EXPECT_EQ(axis.acceleration_mm_s2, 0.0);
  EXPECT_EQ(axis.velocity_bound_mm_s, motion::online::kNoBound);
  EXPECT_EQ(axis.acceleration_bound_mm_s2, motion::online::kNoBound);
}

TEST(MotionStage, GivesNoEstimateWithoutAnEncoder) {
  auto ideal = two_axes();
  ideal.axes[0].encoder.count_au = 0.0;
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
    expect_none(frame.axis[1]);  // its counter is not reported
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

// Counter set, time forwards, time back, counter not reported for one cycle. The bound must hold
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

// The same count and stamp again bring nothing new; taken as a measurement they would narrow and
// shift the estimate.
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

// Half a cycle later without a frame: the old count must not pass for a new one.
TEST(MotionStage, TheSupervisorHasTheEstimatesInTheFrameThatItDecidesBy) {
  auto supervisor = Supervisor::make(two_axes(), {}).value();
  Sine sine;
  for (int i = 0; i < 500; ++i) {
    const auto frame = sine.next();
    supervisor.update(frame);
    if (i % 50 == 49) {  // no reading for a cycle: the old count says nothing about now
      supervisor.update_without_frame(frame.time_s + 0.5 * kCycle_s);
      expect_none(supervisor.frame().axis[0]);
    } else if (i > 200) {
      ASSERT_NEAR(supervisor.frame().axis[0].velocity_mm_s, sine.velocity_mm_s, 0.05) << i;
    }
  }
  supervisor.restore(supervisor.state());
  supervisor.update(sine.next());
  EXPECT_GT(supervisor.frame().axis[0].velocity_bound_mm_s, 1.0) << "the estimates start over";
}

}  // namespace
}  // namespace steadyrest::supervisor
