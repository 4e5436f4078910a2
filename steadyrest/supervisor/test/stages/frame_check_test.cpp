// SPDX-License-Identifier: Apache-2.0
#include <cmath>
#include <functional>
#include <vector>

#include <gtest/gtest.h>

#include <steadyrest/kernel/units/constants.hpp>
#include <steadyrest/supervisor/frame_check.hpp>

namespace steadyrest::supervisor {
namespace {

using kernel::outcome::Reason;
using kernel::signal::Frame;
using kernel::units::kInfinity;
using kernel::units::kNan;

constexpr double kStale_s = 0.1;

/// X of −100 … 100 mm, a rotary axis, and one without limits.
std::vector<kernel::machine::Axis> axes_of_a_lathe() {
  std::vector<kernel::machine::Axis> axes(3);
  axes[0].min_au = -100.0;
  axes[0].max_au = 100.0;
  axes[1].min_au = 0.0;
  axes[1].max_au = 0.0;
  axes[1].rotary = true;
  axes[2].min_au = -kernel::machine::kUnlimited;
  axes[2].max_au = kernel::machine::kUnlimited;
  return axes;
}

Reason judged(const Frame& frame, Reason of_time = Reason::none) {
  return FrameCheck(axes_of_a_lathe(), kStale_s).fault(frame, of_time);
}

using SetNumber = std::function<void(Frame&, double)>;

// Every number that a room computes with, one at a time.
TEST(FrameCheck, ANumberThatIsNotFiniteMakesTheFrameUnfit) {
  const std::vector<SetNumber> fields = {
      [](Frame& frame, double v) { frame.time_s = v; },
      [](Frame& frame, double v) { frame.age_s = v; },
      [](Frame& frame, double v) { frame.programmed_feed_mm_s = v; },
      [](Frame& frame, double v) { frame.path_speed_mm_s = v; },
      [](Frame& frame, double v) { frame.path_position_mm = v; },
      [](Frame& frame, double v) { frame.spindle_programmed_rev_s = v; },
      [](Frame& frame, double v) { frame.spindle_command_rev_s = v; },
      [](Frame& frame, double v) { frame.spindle_actual_rev_s = v; },
      [](Frame& frame, double v) { frame.axis[0].command_mm = v; },
      [](Frame& frame, double v) { frame.axis[1].actual_mm = v; },
      [](Frame& frame, double v) { frame.axis[2].following_error_mm = v; },
  };
  for (std::size_t i = 0; i < fields.size(); ++i) {
    for (const double value : {kNan, kInfinity, -kInfinity}) {
      Frame frame;
      ASSERT_EQ(judged(frame), Reason::none);
      fields[i](frame, value);
      EXPECT_EQ(judged(frame), Reason::input_not_finite) << "field " << i << ": " << value;
    }
  }
}

// Each of these has its own judge, who withdraws one thing and not all.
TEST(FrameCheck, WhatOthersJudgeIsNotLookedAt) {
  Frame frame;
  frame.feed.panel_ratio = kNan;
  frame.rapid.effective_ratio = kNan;
  frame.spindle.panel_ratio = -1.0;
  frame.axis[0].edge_s = kNan;
  frame.axis[0].velocity_bound_mm_s = kInfinity;
  frame.temperature_c[0] = kInfinity;
  frame.probe.displacement_mm = kNan;
  frame.vibration_rate_hz = kNan;
  EXPECT_EQ(judged(frame), Reason::none);
}

TEST(FrameCheck, AxesBeyondThoseShownDoNotCount) {
  Frame frame;
  frame.axis_count = 2;
  frame.axis[2].actual_mm = kNan;
  EXPECT_EQ(judged(frame), Reason::none);
  frame.axis_count = 3;
  EXPECT_EQ(judged(frame), Reason::input_not_finite);
}

// −100 … 100 is 200 mm of travel: up to 200 more on either side may be a wrong offset in the
// machine file; more is garbage.
TEST(FrameCheck, ALinearAxisMayStandItsWholeTravelOutsideOfItsLimits) {
  for (const double sign : {-1.0, 1.0}) {
    for (const bool commanded : {true, false}) {
      Frame frame;
      double& position_mm = commanded ? frame.axis[0].command_mm : frame.axis[0].actual_mm;
      position_mm = sign * 300.0;
      EXPECT_EQ(judged(frame), Reason::none);
      position_mm = sign * std::nextafter(300.0, kInfinity);
      EXPECT_EQ(judged(frame), Reason::input_out_of_range);
    }
  }
}

TEST(FrameCheck, RotaryAndUnlimitedAxesMayStandAnywhere) {
  Frame frame;
  frame.axis[1].actual_mm = 1e7;
  frame.axis[1].command_mm = -1e7;
  frame.axis[2].actual_mm = 1e7;
  EXPECT_EQ(judged(frame), Reason::none);
}

// A position beyond the limits counts only for axes that the frame reports; a machine file may name
// more axes than a frame holds.
TEST(FrameCheck, MoreAxesThanAFrameHoldsAreNoFaultOfTheMachineFileButOfTheFrame) {
  std::vector<kernel::machine::Axis> many(12, axes_of_a_lathe()[0]);
  const FrameCheck check(many, kStale_s);
  Frame frame;
  frame.axis_count = kernel::signal::kMaxAxes;
  EXPECT_EQ(check.fault(frame, Reason::none), Reason::none);
  frame.axis[7].actual_mm = 301.0;
  EXPECT_EQ(check.fault(frame, Reason::none), Reason::input_out_of_range);
  frame.axis_count = 7;
  EXPECT_EQ(check.fault(frame, Reason::none), Reason::none);
  frame.axis_count = kernel::signal::kMaxAxes + 1;
  EXPECT_EQ(check.fault(frame, Reason::none), Reason::input_out_of_range);
}

TEST(FrameCheck, AFeedBelowZeroIsNone) {
  Frame frame;
  frame.programmed_feed_mm_s = -1e-12;
  EXPECT_EQ(judged(frame), Reason::input_out_of_range);
  frame.programmed_feed_mm_s = 0.0;
  EXPECT_EQ(judged(frame), Reason::none);
  frame.path_speed_mm_s = -5.0;  // backwards along the path, as with a retrace
  EXPECT_EQ(judged(frame), Reason::none);
}

// The limit itself is still fresh; a frame further in the future than that has a wrong clock.
TEST(FrameCheck, AgeIsJudgedOnBothSides) {
  const auto aged = [](double age_s) {
    Frame frame;
    frame.age_s = age_s;
    return judged(frame);
  };
  EXPECT_EQ(aged(kStale_s), Reason::none);
  EXPECT_EQ(aged(std::nextafter(kStale_s, 1.0)), Reason::input_stale);
  EXPECT_EQ(aged(-kStale_s), Reason::none);
  EXPECT_EQ(aged(std::nextafter(-kStale_s, -1.0)), Reason::input_out_of_range);
}

// All four at once, then removed from the most serious on.
TEST(FrameCheck, TheGravestFaultIsNamed) {
  Frame frame;
  frame.axis[0].actual_mm = kNan;
  frame.programmed_feed_mm_s = -1.0;
  frame.age_s = 1.0;
  EXPECT_EQ(judged(frame, Reason::heartbeat_lost), Reason::input_not_finite);
  frame.axis[0].actual_mm = 0.0;
  EXPECT_EQ(judged(frame, Reason::heartbeat_lost), Reason::input_out_of_range);
  frame.programmed_feed_mm_s = 0.0;
  EXPECT_EQ(judged(frame, Reason::heartbeat_lost), Reason::heartbeat_lost) << "the clock's verdict";
  EXPECT_EQ(judged(frame), Reason::input_stale);
  frame.age_s = 0.0;
  EXPECT_EQ(judged(frame), Reason::none);
}

}  // namespace
}  // namespace steadyrest::supervisor
