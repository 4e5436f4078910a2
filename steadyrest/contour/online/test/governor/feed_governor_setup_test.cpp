// SPDX-License-Identifier: Apache-2.0
// What the governor makes of the machine file: the steps that it may ask for, the objective, and
// what it refuses.
#include <algorithm>
#include <cmath>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include <steadyrest/contour/online/feed_governor.hpp>
#include <steadyrest/contour/online/test/closed_loop.hpp>
#include <steadyrest/contour/online/test/paths.hpp>
#include <steadyrest/kernel/units/constants.hpp>

namespace steadyrest::contour::online {
namespace {

using kernel::outcome::Reason;
using test::ClosedLoop;
using test::kTurn;
using test::Machine;
using test::PathMaker;

/// The request after a second on a circle of this radius at 1000 mm/min, with the panel wide open.
FeedGovernor::Output settled(const Machine& machine, double radius_mm) {
  const auto path = PathMaker({radius_mm, 0, 0}, 1000.0 / 60.0)
                        .arc({0, 0, 0}, 30.0 / radius_mm)
                        .limited(2000.0, 1.0);
  ClosedLoop loop(machine, path);
  loop.panel = 2.0;
  return loop.run(0.010, 0.0, 1.0).sample.back().output;
}

// On 500 mm of radius no speed errs by a nanometre: the strictest of the three upper limits holds
// the feed, each one in turn. 1.12 lies between two steps.
TEST(FeedGovernorSteps, EndAtTheStrictestOfTheUpperLimits) {
  const auto highest = [](double contour, double envelope, double table) {
    Machine machine = test::mill();
    machine.contour.max_ratio = contour;
    machine.envelope.max_feed_ratio = envelope;
    machine.feed_override.max_ratio = table;
    return settled(machine, 500.0).request.ratio;
  };
  EXPECT_EQ(highest(1.05, 1.2, 2.0), 1.05);
  EXPECT_EQ(highest(1.2, 1.12, 2.0), 1.10);
  EXPECT_EQ(highest(1.2, 1.2, 0.95), 0.95);
}

// Positions that repeat a value are one step, for the search and for whoever looks at the steps.
TEST(FeedGovernorSteps, AreTheTablesDifferentRatios) {
  Machine machine = test::mill();
  const auto plain = FeedGovernor::make(machine).value();
  std::vector<double> repeated;
  for (const double ratio : machine.feed_override.ratio) {
    repeated.insert(repeated.end(), repeated.size() % 3 + 1, ratio);
  }
  machine.feed_override.ratio = repeated;
  machine.feed_override.code.clear();
  const auto many = FeedGovernor::make(machine).value();
  EXPECT_TRUE(std::ranges::equal(plain.steps(), many.steps()));
  for (const double radius_mm : {1.0, 5.0, 500.0}) {
    Machine once = test::mill();
    EXPECT_EQ(settled(machine, radius_mm).request.ratio, settled(once, radius_mm).request.ratio);
  }
}

// On 1 mm even a tenth of 1000 mm/min errs by more than 0.1 µm: the floor is in force, the stricter
// of the two lower limits.
TEST(FeedGovernorSteps, BeginAtTheStricterOfTheLowerLimits) {
  const auto lowest = [](double contour, double envelope) {
    Machine machine = test::mill();
    machine.contour.limit_mm = 1e-4;
    machine.contour.min_ratio = contour;
    machine.envelope.min_feed_ratio = envelope;
    const auto out = settled(machine, 1.0);
    EXPECT_EQ(out.request.reason, Reason::contour_feed_floor);
    return out.request.ratio;
  };
  EXPECT_EQ(lowest(0.20, 0.0), 0.20);
  EXPECT_EQ(lowest(0.10, 0.35), 0.40);
}

// A percent word has 201 steps: each can be chosen.
TEST(FeedGovernorSteps, OfAPercentWordAreAllThere) {
  Machine machine = test::mill();
  machine.feed_override.ratio.clear();
  for (int percent = 0; percent <= 200; ++percent) {
    machine.feed_override.ratio.push_back(percent / 100.0);
  }
  machine.contour.max_ratio = machine.envelope.max_feed_ratio = 2.0;
  for (const double most : {2.0, 1.0, 0.73, 0.41, 0.11}) {
    machine.contour.max_ratio = most;
    EXPECT_EQ(settled(machine, 500.0).request.ratio, most);
  }
}

// Of 1001 steps 256 are searched, including both ends, with gaps of at most 0.8 %.
TEST(FeedGovernorSteps, OfAVeryFineTableAreSpreadOverItsWholeRange) {
  Machine machine = test::mill();
  machine.feed_override.ratio.clear();
  for (int i = 0; i <= 1000; ++i) {
    machine.feed_override.ratio.push_back(i / 500.0);
  }
  machine.contour.max_ratio = machine.envelope.max_feed_ratio = 2.0;
  EXPECT_EQ(settled(machine, 500.0).request.ratio, 2.0) << "the last step";
  for (const double most : {1.0, 0.73, 0.41}) {
    machine.contour.max_ratio = most;
    const auto out = settled(machine, 500.0);
    EXPECT_LE(out.request.ratio, most);
    EXPECT_GE(out.request.ratio, most - 0.008);
    EXPECT_EQ(machine.feed_override.ratio[out.step], out.request.ratio) << "a step of the table";
  }
}

// Steps that are equal are one; a step at 0 stops the machine and is never asked for.
TEST(FeedGovernorSteps, AreNeitherZeroNorTwice) {
  Machine machine = test::mill();
  machine.feed_override.ratio = {0.0, 0.0, 0.5, 0.5, 0.5, 0.9, 0.9};
  machine.contour.min_ratio = 1e-6;
  EXPECT_EQ(settled(machine, 500.0).request.ratio, 0.9);
  machine.contour.limit_mm = 1e-5;
  EXPECT_EQ(settled(machine, 1.0).request.ratio, 0.5);
}

// J = w1·ε/ε_max + w2·(v_max − v)/(v_max − v_min), term by term.
TEST(CombinedObjective, IsThePapersWeightedSum) {
  const Candidate slow{.ratio = 0.2,
                       .error_mm = 0.004,
                       .limit_mm = 0.010,
                       .min_ratio = 0.2,
                       .max_ratio = 1.2,
                       .weight_contour = 0.25,
                       .weight_feed = 0.75};
  EXPECT_NEAR(combined_objective(slow), 0.25 * 0.4 + 0.75, 1e-15);
  Candidate fast = slow;
  fast.ratio = 1.2;
  fast.error_mm = 0.010;
  EXPECT_NEAR(combined_objective(fast), 0.25, 1e-15) << "at the limit the first term is its weight";
  Candidate middle = slow;
  middle.ratio = 0.7;
  middle.error_mm = 0.0;
  EXPECT_NEAR(combined_objective(middle), 0.375, 1e-15);
  Candidate only = slow;
  only.max_ratio = only.min_ratio;
  EXPECT_NEAR(combined_objective(only), 0.1, 1e-15) << "of one step the feed says nothing";
}

FeedGovernor::Config fit_config() {
  return FeedGovernor::Config::of(test::mill());
}

std::string refused(const FeedGovernor::Config& config) {
  const auto made = FeedGovernor::make(config);
  return made ? "" : made.error().what;
}

TEST(FeedGovernorConfig, EachSettingIsRefusedByItsName) {
  EXPECT_EQ(refused(fit_config()), "");
  auto config = fit_config();
  config.contour.margin = 1.0;
  EXPECT_EQ(refused(config), "the contour margin is 1.000000; allowed: 0 … below 1");
  config.contour.margin = kernel::units::kNan;
  EXPECT_NE(refused(config), "");
  config = fit_config();
  config.contour.margin = 0.0;
  EXPECT_EQ(refused(config), "");
  config.contour.min_ratio = 1.1;
  EXPECT_EQ(refused(config),
            "the feed ratios of [contour] are 1.100000 … 1.000000; allowed: above 0, rising");
  config.contour.min_ratio = 0.0;
  EXPECT_NE(refused(config), "");
  config = fit_config();
  config.contour.min_ratio = config.contour.max_ratio = 1.0;
  EXPECT_EQ(refused(config), "") << "one step is enough";
  config.envelope.feed_rise_1_s = 0.0;
  EXPECT_EQ(refused(config),
            "the feed's slew limits are 10.000000 1/s down and 0.000000 1/s up; allowed: above 0");
  config.envelope.feed_rise_1_s = 2.0;
  config.envelope.feed_fall_1_s = -1.0;
  EXPECT_NE(refused(config), "");
}

TEST(FeedGovernorConfig, WorkAndObjectiveAreRefusedByTheirNames) {
  auto config = fit_config();
  config.work_share = 1.0;
  EXPECT_EQ(refused(config), "");
  config.work_share = 1.01;
  EXPECT_EQ(refused(config), "work_share is 1.010000; allowed: above 0 … 1");
  config.work_share = 0.0;
  EXPECT_NE(refused(config), "");
  config = fit_config();
  config.objective = nullptr;
  EXPECT_EQ(refused(config), "no objective is given");
  config = fit_config();
  config.axes[1].servo_gain_1_s = 0.5;
  EXPECT_NE(refused(config).find("the servo gain is 0.5"), std::string::npos);
}

// 1023 cycles of words are remembered; half of the forecast's 512 steps of 2.4 ms is less.
TEST(FeedGovernorSetup, RefusesAnOverrideThatActsLaterThanItCanForesee) {
  Machine machine = test::mill();
  machine.feed_override.dead_time_s = 0.3;
  EXPECT_TRUE(FeedGovernor::make(machine));
  machine.feed_override.dead_time_s = 1.1;
  const auto made = FeedGovernor::make(machine);
  ASSERT_FALSE(made);
  EXPECT_NE(made.error().what.find("acts up to 11"), std::string::npos);
  EXPECT_NE(made.error().to_do.find("dead_time_ms"), std::string::npos);
}

}  // namespace
}  // namespace steadyrest::contour::online
