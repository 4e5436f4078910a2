// SPDX-License-Identifier: Apache-2.0
// Advice where nothing is written: on odd machines, with odd clocks, and over many hours.
#include <algorithm>
#include <cmath>
#include <cstdint>
#include <limits>
#include <random>
#include <vector>

#include <gtest/gtest.h>

#include <steadyrest/contour/online/feed_governor.hpp>
#include <steadyrest/contour/online/test/closed_loop.hpp>
#include <steadyrest/contour/online/test/paths.hpp>

namespace steadyrest::contour::online {
namespace {

using kernel::machine::ContourStrategy;
using kernel::signal::Frame;
using kernel::signal::InForce;
using kernel::signal::Motion;
using test::circle;
using test::ClosedLoop;
using test::kTurn;
using test::Machine;
using test::PathMaker;
using test::PathSegment;

/// A machine at the panel's feed, and a layer that looks on.
struct Observed {
  Observed(const Machine& machine, const std::vector<PathSegment>& path, double panel,
           const Machine& real)
      : layer(FeedGovernor::make(machine).value()), loop(real, machine, path) {
    loop.with_layer = false;
    loop.panel = loop.fixed_ratio = panel;
    loop.disturb = [this](Frame& frame) {
      in_force.feed = {.ratio = loop.panel, .word_ratio = loop.panel};
      output = layer.update(frame, in_force);
      seen = frame;
    };
  }
  Observed(const Machine& machine, const std::vector<PathSegment>& path, double panel = 1.0)
      : Observed(machine, path, panel, machine) {}
  void until(double time_s) {
    while (!loop.done() && loop.step().time_s < time_s) {
    }
  }
  FeedGovernor layer;
  ClosedLoop loop;
  InForce in_force;
  Frame seen;
  FeedGovernor::Output output;
};

// On this circle the layer, acting, has 30 % in force: FeedGovernor tests.
const double kHeld = 0.30;

/// By how much the shadow is ahead before the circle at the end of this way; on the circle the
/// advice is asserted.
double ahead_s(Observed& observed, double circle_from_mm) {
  double lead_s = 0.0;
  while (!observed.loop.done()) {
    const double position_mm = observed.loop.step().position_mm;
    lead_s = std::min(lead_s, observed.layer.course().shadow.lead_s);
    if (position_mm > circle_from_mm + 60.0 && position_mm < circle_from_mm + 120.0) {
      EXPECT_NEAR(observed.output.advised_ratio, kHeld, 0.05) << position_mm;
    }
  }
  return -lead_s;
}

TEST(FeedGovernorShadow, DecisionsGoOnWhereTheLayerMayExceedThePanel) {
  Machine machine = test::mill(50.0);
  machine.feed_override.layer_may_exceed_panel = true;
  PathMaker path({10, 700, 0}, 4000.0 / 60.0);
  path.line_to({10, 200, 0}).motion(Motion::rapid).line_to({10, 0, 0});
  path.motion(Motion::feed).arc({0, 0, 0}, 2 * kTurn);
  const auto part = path.limited(1000.0, 10.0);
  Observed observed(machine, part, 0.5);
  EXPECT_GT(ahead_s(observed, 700.0), 5.0);
}

TEST(FeedGovernorShadow, DecisionsGoOnWhereTheControlIsSlowerThanItsFileSays) {
  const Machine machine = test::mill(50.0);
  PathMaker path({10, 100, 0}, 4000.0 / 60.0);
  for (int i = 1; i <= 200; ++i) {
    path.line_to({10.0 + 2.0 * (i % 2), 100, 0});
  }
  path.motion(Motion::rapid).line_to({10, 0, 0}).motion(Motion::feed).arc({0, 0, 0}, 2 * kTurn);
  const auto part = path.limited(1000.0, 10.0);
  Machine slower = machine;
  slower.axes[0].max_acceleration_au_s2 /= 10.0;
  Observed observed(machine, part, 1.0, slower);
  EXPECT_GT(ahead_s(observed, 500.0), 5.0);
}

TEST(FeedGovernorShadow, AFrameThatComesAgainIsNoTime) {
  const Machine machine = test::mill(50.0);
  const auto path = circle(10.0, 4000.0, 6.0);
  Observed observed(machine, path);
  while (!observed.loop.done()) {
    observed.loop.step();
    const double lead_s = observed.layer.course().shadow.lead_s;
    observed.output = observed.layer.update(observed.seen, observed.in_force);
    ASSERT_EQ(observed.layer.course().shadow.lead_s, lead_s);
    if (observed.seen.time_s > 2.0 && observed.seen.path_position_mm < 350.0) {
      ASSERT_NEAR(observed.output.advised_ratio, kHeld, 0.05) << observed.seen.time_s;
    }
  }
}

// A layer that acts hands back by the slew while its input is unfit.
TEST(FeedGovernorShadow, GoesBackByTheSlewWhileTheInputIsUnfit) {
  const Machine machine = test::mill(50.0);
  const auto path = circle(10.0, 4000.0, 20.0);
  for (const bool is_stale : {false, true}) {
    Observed observed(machine, path);
    observed.until(2.0);
    double before = observed.output.advised_ratio;
    ASSERT_NEAR(before, kHeld, 0.05);
    for (int cycle = 0; cycle < 3000; ++cycle) {
      Frame frame = observed.seen;
      frame.time_s += 0.001 * (cycle + 1);
      frame.age_s = is_stale ? 10.0 : 0.0;
      frame.axis[1].actual_mm =
          is_stale ? frame.axis[1].actual_mm : std::numeric_limits<double>::quiet_NaN();
      const auto output = observed.layer.update(frame, observed.in_force);
      ASSERT_NEAR(output.advised_ratio, before, machine.envelope.feed_rise_1_s * 0.00101);
      before = output.advised_ratio;
    }
    EXPECT_DOUBLE_EQ(before, 1.0);
  }
}

// Stiff axes have short forecast steps: at a tenth of the feed a long cycle takes hundreds.
TEST(FeedGovernorShadow, KeepsUpWithTheMachineAtLowRatiosInLongCycles) {
  Machine machine = test::mill(300.0);
  machine.control.interpolator_period_s = 0.020;
  machine.contour.limit_mm = 0.0005;
  const auto path = circle(2.0, 4000.0, 5.0);
  Observed observed(machine, path);
  double pace = 0.0;
  for (double position_mm = 0.0; position_mm < 55.0;) {
    position_mm = observed.loop.step().position_mm;
    if (position_mm > 20.0) {
      ASSERT_GT(observed.layer.course().shadow.outset.position_mm, position_mm - 1e-9);
      pace = std::max(pace, observed.output.pace);
    }
  }
  EXPECT_GT(pace, 9.0);
}

/// One odd layer: its machine and what it is told.
struct Odd {
  Machine machine = test::mill(50.0);
  double cycle_s = 0.001;
};

Odd odd(std::mt19937& random) {
  Odd out;
  const auto pick = [&random](int n) {
    return static_cast<int>(random() % static_cast<unsigned>(n));
  };
  auto& table = out.machine.feed_override.ratio;
  switch (pick(4)) {
    case 0:
      table = {1.0};
      break;
    case 1:
      table.clear();
      for (int i = 0; i < 256; ++i) {
        table.push_back(i / 255.0 * 1.2);
      }
      break;
    case 2:
      table = {0.0, 0.5, 0.5, 0.5, 1.0, 1.0};
      break;
    default:
      break;
  }
  out.cycle_s = std::vector{0.001, 0.004, 0.020}[static_cast<std::size_t>(pick(3))];
  out.machine.control.interpolator_period_s = out.cycle_s;
  out.machine.contour.strategy =
      std::vector{ContourStrategy::feed_priority, ContourStrategy::contour_priority,
                  ContourStrategy::combined}[static_cast<std::size_t>(pick(3))];
  out.machine.envelope.max_path_offset_mm = pick(2) == 0 ? 0.5 : 0.0;
  out.machine.feed_override.layer_may_exceed_panel = pick(3) == 0;
  out.machine.contour.min_ratio = pick(2) == 0 ? 0.1 : 0.01;
  return out;
}

// Panels, modes, clocks, paths and values as no machine has them: the advice is a ratio that the
// layer may have, and a decision costs no more than ever.
TEST(FeedGovernorShadow, WhateverIsShownTheAdviceIsOneThatTheLayerMayGive) {
  constexpr double kNan = std::numeric_limits<double>::quiet_NaN();
  PathMaker maker({10, 0, 0}, 4000.0 / 60.0);
  maker.arc({0, 0, 0}, 2 * kTurn).line_to({10, 60, 0}).motion(Motion::rapid);
  maker.line_to({10, 100, 0})
      .motion(Motion::feed)
      .arc({0, 100, 0}, 2 * kTurn)
      .line_to({40, 100, 0});
  const auto path = maker.limited(1000.0, 10.0);
  for (std::uint32_t seed = 0; seed < 60; ++seed) {
    std::mt19937 random(seed);
    const auto chance = [&random](unsigned n) { return random() % n == 0; };
    const Odd of = odd(random);
    Observed observed(of.machine, path);
    double jump_s = 0.0;
    double stale_s = 0.0;
    bool shows_path = true;
    observed.loop.disturb = [&](Frame& frame) {
      jump_s += chance(400) ? 5.0 : chance(400) ? -3.0 : chance(100) ? -of.cycle_s : 0.0;
      frame.time_s = chance(500) ? kNan : frame.time_s + jump_s;
      shows_path = chance(300) ? !shows_path : shows_path;
      if (!shows_path) {
        frame.path = {};
      }
      if (chance(300)) {
        observed.loop.panel = observed.loop.fixed_ratio =
            std::vector{0.0, 0.1, 0.5, 1.0, 1.2}[random() % 5];
      }
      frame.feed.panel_ratio = chance(300) ? kNan : frame.feed.panel_ratio;
      frame.rapid.effective_ratio = chance(10) ? 0.0 : 1.0;
      frame.motion = chance(100) ? Motion::idle : frame.motion;
      frame.axis[0].actual_mm = chance(500) ? kNan : frame.axis[0].actual_mm;
      stale_s = chance(200) ? 1.0 - stale_s : stale_s;
      frame.age_s = stale_s;
      if (chance(500)) {
        observed.in_force.written = !observed.in_force.written;
      }
      observed.in_force.active = observed.in_force.written || chance(2);
      observed.in_force.feed = {.ratio = observed.loop.panel, .word_ratio = observed.loop.panel};
      observed.output = observed.layer.update(frame, observed.in_force);
    };
    for (int cycle = 0; cycle < 8000 && !observed.loop.done(); ++cycle) {
      observed.loop.step();
      const auto& output = observed.output;
      ASSERT_GE(output.advised_ratio, 0.0) << "seed " << seed << ", cycle " << cycle;
      ASSERT_LE(output.advised_ratio, of.machine.envelope.max_feed_ratio)
          << "seed " << seed << ", cycle " << cycle;
      ASSERT_GE(output.pace, 0.0);
      ASSERT_TRUE(std::isfinite(output.pace));
      ASSERT_LE(output.forecast_steps, observed.layer.most_forecast_steps());
    }
  }
}

}  // namespace
}  // namespace steadyrest::contour::online
