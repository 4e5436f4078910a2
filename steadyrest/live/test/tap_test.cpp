// SPDX-License-Identifier: Apache-2.0
#include <cmath>
#include <cstddef>
#include <memory>
#include <vector>

#include <gtest/gtest.h>

#include <steadyrest/kernel/rt/testing/allocation_guard.hpp>
#include <steadyrest/live/loop.hpp>
#include <steadyrest/live/tap.hpp>
#include <steadyrest/live/test/desk.hpp>

namespace steadyrest::live {
namespace {

using kernel::machine::Mode;
using test::Desk;

Loop::Config tapped(const Desk& desk, Tap& tap, std::uint64_t cycles) {
  Loop::Config config{.period_s = desk.machine.control.interpolator_period_s,
                      .contour_limit_mm = 0.01,
                      .mode = Mode::observe,
                      .most_cycles = cycles};
  config.tap = &tap;
  return config;
}

TEST(Tap, HasEveryCycleOnceAndThePathAhead) {
  Desk desk;
  Tap tap;
  tap.watch(true);
  Loop loop(*desk.port, *desk.layer, desk.pace, tapped(desk, tap, 200));
  loop.run();
  std::vector<TapSample> samples;
  EXPECT_EQ(tap.take(samples), 0U);
  ASSERT_EQ(samples.size(), 200U);
  for (std::size_t i = 0; i < samples.size(); ++i) {
    EXPECT_EQ(samples[i].cycle, i + 1);
  }
  const TapSample& last = samples.back();
  EXPECT_TRUE(last.error_known);
  EXPECT_GT(last.path_speed_mm_s, 0.0);
  // The circle that the desk's machine cuts: even steps along it, from about the last position on.
  const PathAhead& ahead = tap.ahead();
  ASSERT_GT(ahead.count, 20U);
  const auto apart = [&](std::size_t i) {
    return std::hypot(ahead.point_mm[i][0] - ahead.point_mm[i - 1][0],
                      ahead.point_mm[i][1] - ahead.point_mm[i - 1][1]);
  };
  for (std::size_t i = 1; i + 1 < ahead.count; ++i) {
    EXPECT_NEAR(apart(i), apart(1), 0.01 * apart(1)) << i;
  }
  EXPECT_NEAR(ahead.point_mm[ahead.count - 1][0], 10.0, 1e-9) << "to the path's end";
  EXPECT_LT(std::hypot(ahead.point_mm[0][0] - last.position_mm[0],
                       ahead.point_mm[0][1] - last.position_mm[1]),
            5.0);
}

TEST(Tap, HasNothingOfTheTimeBeforeSomebodyWatches) {
  Desk desk;
  Tap tap;
  tap.watch(true);
  Loop loop(*desk.port, *desk.layer, desk.pace, tapped(desk, tap, 200));
  loop.run();
  tap.watch(true);  // still
  std::vector<TapSample> samples;
  tap.take(samples);
  EXPECT_EQ(samples.size(), 200U);
  Loop more(*desk.port, *desk.layer, desk.pace, tapped(desk, tap, 50));
  more.run();
  tap.watch(false);
  tap.watch(true);
  tap.take(samples);
  EXPECT_TRUE(samples.empty());
}

TEST(Tap, CarriesTheVibrationOfEachCycleInOrder) {
  Tap tap;
  kernel::signal::Frame frame;
  std::vector<double> readings(20);
  std::vector<double> taken;
  const auto put = [&](double first) {
    for (std::size_t i = 0; i < readings.size(); ++i) {
      readings[i] = first + static_cast<double>(i);
    }
    frame.vibration = readings;
    frame.vibration_rate_hz = 10e3;
    tap.put({}, frame);
  };
  put(0.0);
  EXPECT_EQ(tap.take_vibration(taken), 0.0) << "nobody watches";
  EXPECT_TRUE(taken.empty());
  tap.watch(true);
  put(100.0);
  put(120.0);
  EXPECT_EQ(tap.take_vibration(taken), 10e3);
  ASSERT_EQ(taken.size(), 40U);
  for (std::size_t i = 0; i < taken.size(); ++i) {
    EXPECT_EQ(taken[i], 100.0 + static_cast<double>(i));
  }
  // Nobody takes: bounded, and what is there stays in order.
  {
    const kernel::rt::testing::AllocationGuard guard;
    for (int i = 0; i < 5000; ++i) {
      tap.put({}, frame);
    }
    EXPECT_EQ(guard.allocations(), 0U);
  }
  tap.take_vibration(taken);
  EXPECT_EQ(taken.size(), 65'536U);
  tap.take_vibration(taken);
  EXPECT_TRUE(taken.empty());
}

TEST(Tap, LosesTheNewestAndCountsThemWhereNobodyTakes) {
  Tap tap;
  tap.watch(true);
  LiveStatus status;
  for (std::uint64_t n = 1; n <= 5000; ++n) {
    status.cycles = n;
    tap.put(status, {});
  }
  std::vector<TapSample> samples;
  EXPECT_EQ(tap.take(samples), 5000U - 4096U);
  EXPECT_EQ(samples.back().cycle, 4096U);
  tap.put(status, {});
  tap.take(samples);
  EXPECT_EQ(samples.size(), 1U);
}

TEST(Tap, DoesNothingWhileNobodyWatches) {
  Tap tap;
  tap.put({}, {});
  std::vector<TapSample> samples;
  tap.take(samples);
  EXPECT_TRUE(samples.empty());
}

/// Commands and steps of a run on the circle, in act.
struct TappedRun {
  std::vector<kernel::signal::Command> commands;
  StepErrors steps;
  std::vector<double> asked;
};
TappedRun run_on_circle(bool watched, std::uint64_t cycles) {
  Desk desk;
  const auto tap = std::make_unique<Tap>();
  tap->watch(watched);
  TappedRun out;
  Loop::Config config = tapped(desk, *tap, cycles);
  config.mode = Mode::act;
  config.on_command = [&](const auto& command) {
    out.commands.push_back(command);
    if (out.commands.size() == 500) {  // in the cut
      out.steps = tap->steps();
    }
  };
  Loop loop(*desk.port, *desk.layer, desk.pace, config);
  loop.run();
  const auto ratio = desk.layer->feed_steps();
  out.asked.assign(ratio.begin(), ratio.end());
  return out;
}

TEST(Tap, HasWhatEachStepWouldGiveWhileSomebodyWatches) {
  const TappedRun run = run_on_circle(true, 1500);
  ASSERT_EQ(run.steps.count, 23U);
  for (std::size_t i = 0; i < run.steps.count; ++i) {
    const StepErrors::Step& step = run.steps.step[i];
    EXPECT_EQ(step.ratio, run.asked[i]);
    EXPECT_TRUE(std::isfinite(step.held_mm) && std::isfinite(step.change_mm)) << step.ratio;
    // Faster is worse on a circle; the speed limit of the arc makes the fastest ones alike.
    EXPECT_GE(step.held_mm, i == 0 ? -1e-4 : run.steps.step[i - 1].held_mm - 1e-4) << step.ratio;
  }
  EXPECT_GT(run.steps.step[22].held_mm, 4.0 * run.steps.step[8].held_mm);
  EXPECT_EQ(run_on_circle(false, 1500).steps.count, 0U);
}

TEST(Tap, ChangesNoCommandByWatching) {
  const TappedRun with = run_on_circle(true, 1500);
  const TappedRun without = run_on_circle(false, 1500);
  ASSERT_EQ(with.commands.size(), without.commands.size());
  for (std::size_t i = 0; i < with.commands.size(); ++i) {
    ASSERT_EQ(with.commands[i].feed_ratio, without.commands[i].feed_ratio) << i;
    ASSERT_EQ(with.commands[i].feed_reason, without.commands[i].feed_reason) << i;
    ASSERT_EQ(with.commands[i].path_offset_mm, without.commands[i].path_offset_mm) << i;
  }
}

TEST(Tap, ForgetsTheStepsWhereNoPathIsAhead) {
  Desk desk;
  Tap tap;
  tap.watch(true);
  Loop loop(*desk.port, *desk.layer, desk.pace, tapped(desk, tap, 300));
  loop.run();
  EXPECT_EQ(tap.steps().count, 23U);
  LiveStatus fault;
  fault.port_fault = true;
  tap.look_at_steps(fault, *desk.layer);
  EXPECT_EQ(tap.steps().count, 0U);
}

TEST(Tap, LooksWithoutAllocating) {
  Desk desk;
  Tap tap;
  tap.watch(true);
  Loop loop(*desk.port, *desk.layer, desk.pace, tapped(desk, tap, 300));
  loop.run();
  const kernel::rt::testing::AllocationGuard guard;
  for (int n = 0; n < 100; ++n) {
    tap.look_at_steps({}, *desk.layer);
    tap.look_at_heat({}, *desk.layer);
  }
  EXPECT_EQ(guard.allocations(), 0U);
}

TEST(Tap, AllocatesNothingInTheCycle) {
  Tap tap;
  tap.watch(true);
  const kernel::rt::testing::AllocationGuard guard;
  for (int n = 0; n < 100; ++n) {
    tap.put({}, {});
  }
  EXPECT_EQ(guard.allocations(), 0U);
}

}  // namespace
}  // namespace steadyrest::live
