// SPDX-License-Identifier: Apache-2.0
// What a value says before anybody has filled it in: nothing that moves a machine.
#include <cmath>
#include <limits>

#include <gtest/gtest.h>

#include <steadyrest/kernel/signal/command.hpp>
#include <steadyrest/kernel/signal/frame.hpp>
#include <steadyrest/kernel/signal/in_force.hpp>
#include <steadyrest/kernel/signal/request.hpp>

namespace steadyrest::kernel::signal {
namespace {

TEST(Signal, ACommandThatNobodyFilledInMustNotBeWritten) {
  const Command command;
  EXPECT_FALSE(command.write);
  EXPECT_FALSE(command.feed_masks_panel);
  EXPECT_FALSE(command.spindle_masks_panel);
  EXPECT_EQ(command.feed_ratio, 1.0);
  EXPECT_EQ(command.spindle_ratio, 1.0);
  EXPECT_EQ(command.offset_mm, AxisValues{});
  EXPECT_EQ(command.path_offset_mm, AxisValues{});
  EXPECT_FALSE(InForce{}.active || InForce{}.written);
}

TEST(Signal, ARequestIsNeutralUntilARoomWishes) {
  EXPECT_EQ(FeedRequest{}.ratio, 1.0);
  EXPECT_EQ(FeedRequest{}.reason, outcome::Reason::none);
  EXPECT_EQ(SpindleRequest{}.ratio, 1.0);
  EXPECT_EQ(OffsetRequest{}.offset_mm, AxisValues{});
  for (const double slope_mm_s : OffsetRequest{}.slope_mm_s) {
    EXPECT_EQ(slope_mm_s, std::numeric_limits<double>::infinity());
  }
}

// A temperature of 0 °C or a speed of exactly 0 would be a reading.
TEST(Signal, WhatWasNotMeasuredIsNotKnown) {
  const Frame frame;
  for (const double temperature_c : frame.temperature_c) {
    EXPECT_TRUE(std::isnan(temperature_c));
  }
  EXPECT_EQ(frame.probe.number, 0U);
  EXPECT_TRUE(std::isnan(frame.probe.displacement_mm));
  for (const AxisSample& axis : frame.axis) {
    EXPECT_TRUE(std::isinf(axis.velocity_bound_mm_s) && std::isinf(axis.acceleration_bound_mm_s2));
    EXPECT_TRUE(std::isnan(axis.edge_s));
    EXPECT_FALSE(axis.encoder_shown);
  }
}

// G1–G3, G33, G76 and G84 cut; everything else may be offset in air.
TEST(Signal, TheToolIsInTheCutInFeedThreadAndTapAlone) {
  for (const Motion cutting : {Motion::feed, Motion::thread, Motion::tap}) {
    EXPECT_TRUE(in_cut(cutting));
  }
  for (const Motion air : {Motion::idle, Motion::rapid, Motion::probe, Motion::dwell,
                           Motion::tool_change, Motion::spindle_wait}) {
    EXPECT_FALSE(in_cut(air));
  }
}

}  // namespace
}  // namespace steadyrest::kernel::signal
