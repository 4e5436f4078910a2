// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <cstdint>
#include <vector>

#include <gtest/gtest.h>
#include <rapidcheck.h>
#include <rapidcheck/gtest.h>

#include <steadyrest/contour/online/feed_governor.hpp>
#include <steadyrest/contour/online/test/closed_loop.hpp>
#include <steadyrest/contour/online/test/paths.hpp>

// How much a decision costs, counted in forecast steps: the same on every computer.
namespace steadyrest::contour::online {
namespace {

using kernel::machine::ContourStrategy;
using test::ClosedLoop;
using test::kTurn;
using test::Machine;
using test::PathMaker;
using test::pocket;

std::vector<double> fine_table(std::size_t steps) {
  std::vector<double> ratio(steps);
  for (std::size_t i = 0; i < steps; ++i) {
    ratio[i] = static_cast<double>(i) / static_cast<double>(steps - 1);
  }
  return ratio;
}

/// A machine whose forecasts are as long as they get: one axis settles slowly, another needs short
/// steps, the override falls slowly.
Machine slow_to_foresee(double slowest_gain_1_s, double slew_1_s) {
  Machine machine = test::mill(50.0);
  machine.axes[1].servo_gain_1_s = slowest_gain_1_s;
  machine.feed_override.ratio = fine_table(201);
  machine.feed_override.scan_period_s = 0.001;
  machine.feed_override.dead_time_s = 0.0;
  machine.contour.min_ratio = 0.05;
  machine.envelope.feed_fall_1_s = machine.envelope.feed_rise_1_s = slew_1_s;
  return machine;
}

std::size_t most_steps_of_a_decision(const Machine& machine, const FeedGovernor::Config& config,
                                     double seconds) {
  const auto path = pocket(60.0);
  ClosedLoop loop(machine, path);
  loop.governor() = FeedGovernor::make(config).value();
  loop.offsets_act = true;
  std::uint32_t most = 0;
  for (double t = 0.0; t < seconds && !loop.done(); t += machine.control.interpolator_period_s) {
    most = std::max(most, loop.step().output.forecast_steps);
  }
  return most;
}

// The cycle is planned with this bound; the worst machines have the longest forecasts and the
// finest tables.
RC_GTEST_PROP(FeedGovernorWork, IsBoundedOnAnyMachineByAnyStrategy, ()) {
  Machine machine =
      slow_to_foresee(*rc::gen::element(1.0, 2.0, 20.0), *rc::gen::element(0.01, 0.2, 2.0, 100.0));
  machine.feed_override.ratio = fine_table(*rc::gen::element<std::size_t>(11, 33, 64, 201));
  machine.contour.strategy = *rc::gen::element(
      ContourStrategy::contour_priority, ContourStrategy::feed_priority, ContourStrategy::combined);
  machine.control.interpolator_period_s = *rc::gen::element(0.0001, 0.001, 0.004);
  machine.envelope.max_path_offset_mm = *rc::gen::element(0.0, 1.0);
  FeedGovernor::Config config = FeedGovernor::Config::of(machine);
  config.path_offset_acceleration_mm_s2 = *rc::gen::element(0.0, 400.0);
  config.forecast_step_s = *rc::gen::element(0.0, 1e-4);
  const std::size_t bound = FeedGovernor::make(config).value().most_forecast_steps();
  const std::size_t most = most_steps_of_a_decision(machine, config, 0.2);
  RC_ASSERT(most > 0U);
  RC_ASSERT(most <= bound);
}

// Two forecasts of 0.25 s, in steps of 2.4 ms at 50 1/s, say whether slow offsets follow; in steps
// of 0.1 ms they end at the most that a forecast has.
TEST(FeedGovernorWork, CountsTheForecastsOfSlowOffsets) {
  Machine machine = test::mill(50.0);
  machine.control.interpolator_period_s = 0.001;
  machine.envelope.max_path_offset_mm = 1.0;
  const auto path = PathMaker({0, 0, 0}, 20.0).line_to({100, 0, 0}).limited(2000.0, 1.0);
  const auto steps = [&](double acceleration_mm_s2, double step_s) {
    FeedGovernor::Config config = FeedGovernor::Config::of(machine);
    config.path_offset_acceleration_mm_s2 = acceleration_mm_s2;
    config.forecast_step_s = step_s;
    config.feed_override.dead_time_s = 0.0;
    ClosedLoop loop(machine, path);
    loop.governor() = FeedGovernor::make(config).value();
    loop.offsets_act = true;
    FeedGovernor::Output output;
    while (!output.decided || loop.step().time_s < 1.0) {
      const auto now = loop.step().output;
      output = now.decided ? now : output;
    }
    return output.forecast_steps;
  };
  EXPECT_EQ(steps(400.0, 0.0) - steps(0.0, 0.0), 2U * 104U);
  EXPECT_EQ(steps(400.0, 1e-4) - steps(0.0, 1e-4), 2U * 512U);
}

// 10 % of 1 ms at 100 ns each are 1000 steps; a forecast has 512 at most.
TEST(FeedGovernorWork, OfAMillisecondCycleIsAThousandForecastStepsAndFiveForecasts) {
  Machine machine = test::mill(50.0);
  machine.control.interpolator_period_s = 0.001;
  EXPECT_EQ(FeedGovernor::make(machine).value().most_forecast_steps(), 1000U + 4U * 512U);
  machine.contour.strategy = ContourStrategy::combined;
  EXPECT_EQ(FeedGovernor::make(machine).value().most_forecast_steps(), 2000U + 5U * 512U);
  FeedGovernor::Config config = FeedGovernor::Config::of(machine);
  config.path_offset_acceleration_mm_s2 = 400.0;
  EXPECT_EQ(FeedGovernor::make(config).value().most_forecast_steps(), 2000U + 7U * 512U)
      << "and two for offsets that are slow";
}

// With a tenth of the share the search must be interrupted and resumed, and must find a step as
// good as in one go.
TEST(FeedGovernorWork, AnObjectiveThatDoesNotFitIntoOneDecisionIsFoundOverSeveral) {
  const auto path =
      PathMaker({10, 0, 0}, 4000.0 / 60.0).arc({0, 0, 0}, 8 * kTurn).limited(2000.0, 1.0);
  Machine machine = slow_to_foresee(2.0, 10.0);
  for (auto& axis : machine.axes) {
    axis.servo_gain_1_s = 50.0;
  }
  machine.axes[2].servo_gain_1_s = 1.0;  // the circle does not move it, its settling is waited for
  machine.contour.strategy = ContourStrategy::combined;
  for (const double work_share : {1.0, 0.1}) {
    ClosedLoop loop(machine, path);
    FeedGovernor::Config config = FeedGovernor::Config::of(machine);
    config.work_share = work_share;
    loop.governor() = FeedGovernor::make(config).value();
    bool left = false;
    while (loop.step().time_s < 3.0) {
      left = left || !loop.governor().course().objective.done();
    }
    EXPECT_EQ(left, work_share < 1.0);
    // The closed form's optimum is 0.18; a search already includes what the tool has cut.
    EXPECT_GE(loop.governor().course().wanted_ratio, 0.15);
    EXPECT_LE(loop.governor().course().wanted_ratio, 0.35);
  }
}

}  // namespace
}  // namespace steadyrest::contour::online
