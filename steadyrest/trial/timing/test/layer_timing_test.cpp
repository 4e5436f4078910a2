// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include <steadyrest/trial/test/examples.hpp>
#include <steadyrest/trial/timing/judgement.hpp>
#include <steadyrest/trial/timing/layer_timing.hpp>

// The times depend on the computer; that they are measured and ordered does not.
namespace steadyrest::trial::timing {
namespace {

using kernel::machine::Machine;
using test::machine_of;

void expect_ordered(const Quantiles& of) {
  EXPECT_GT(of.p50, 0.0);
  EXPECT_LE(of.p50, of.p999);
  EXPECT_LE(of.p999, of.worst);
}

// Counts are exact; times only have to be positive and in order.
TEST(LayerTiming, MeasuresAsManyDecisionsAsItIsTold) {
  std::vector<double> progress;
  const auto timing =
      time_layer(machine_of("vmc-840d.toml"), {.decisions = 100, .rounds = 2}, [&](double share) {
        progress.push_back(share);
      }).value();
  EXPECT_EQ(timing.cycle_s, 0.004);
  EXPECT_EQ(timing.rounds, 2);
  EXPECT_EQ(timing.decisions, 100U);
  // A decision every 10 ms, which are two and a half cycles.
  EXPECT_GE(timing.cycles, 248U);
  EXPECT_LE(timing.cycles, 260U);
  expect_ordered(timing.work_s);
  expect_ordered(timing.decision_s);
  EXPECT_GT(timing.decision_s.p50, timing.work_s.p50);
  EXPECT_TRUE(std::ranges::is_sorted(progress));
  EXPECT_EQ(progress.size(), 2U);
}

// Only the contour room decides; the rest of the cycle is still timed.
TEST(LayerTiming, OfAMachineWhoseContourIsLeftAloneHasNoDecisions) {
  Machine machine = machine_of("vmc-840d.toml");
  machine.contour.enabled = false;
  const auto timing =
      time_layer(machine, {.decisions = 20, .rounds = 1}, [](double /*share*/) {}).value();
  EXPECT_EQ(timing.decisions, 0U);
  EXPECT_GT(timing.cycles, 50U);
  expect_ordered(timing.work_s);
  EXPECT_EQ(timing.decision_s.worst, 0.0);
}

/// Where not even the fall keeps the limit, a decision makes four forecasts whatever its share,
/// here of 512 steps each. Half of this cycle leaves 12 ns per step; today's computers take two to
/// four times as long.
TEST(LayerTiming, OfAMachineThatNoComputerCanFollowIsAFinding) {
  Machine machine = machine_of("linuxcnc-mill.toml");
  machine.control.interpolator_period_s = machine.control.servo_period_s = 50e-6;
  machine.envelope.feed_fall_1_s = machine.envelope.feed_rise_1_s = 0.01;
  const auto timing =
      time_layer(machine, {.decisions = 100, .rounds = 1}, [](double /*share*/) {}).value();
  EXPECT_EQ(timing.decisions, 100U);
  EXPECT_EQ(judge(timing, machine).size(), 1U);
}

TEST(LayerTiming, RefusesWhatTheLayerRefuses) {
  Machine machine = machine_of("linuxcnc-mill.toml");
  machine.axes[0].servo_gain_1_s = 0.5;
  const auto timing = time_layer(machine, {}, [](double /*share*/) {});
  ASSERT_FALSE(timing);
  EXPECT_NE(timing.error().what.find("servo gain"), std::string::npos);
}

}  // namespace
}  // namespace steadyrest::trial::timing
