// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include <steadyrest/sim/base/test/switch_code.hpp>
#include <steadyrest/sim/simulated_machine.hpp>
#include <steadyrest/sim/test/milled.hpp>

namespace steadyrest::sim {
namespace {

using kernel::machine::Machine;
using kernel::signal::Frame;
using kernel::signal::Motion;
using test::code_of;
using test::line;
using test::machine_of;
using test::mill;
using test::plan;
using test::run;

// Half the feed, twice the time, except for acceleration and the override's dead time.
TEST(SimulatedMachine, TheLayersWordActsThroughThePort) {
  const Machine machine = mill();
  const auto path = plan(machine, {line(0.0, 0.0, 200.0, 0.0)});
  auto plain = machine_of(machine, path);
  auto slowed = machine_of(machine, path);
  EXPECT_TRUE(slowed->capability().feed_override);
  const double full = run(*plain, [](const Frame&) {});
  kernel::signal::Command command;
  command.write = true;
  command.feed_masks_panel = true;
  command.feed_code = code_of(50);
  const double half = run(*slowed, [&](const Frame&) {
    ++command.heartbeat;
    ASSERT_TRUE(slowed->write(command));
  });
  EXPECT_NEAR(half / full, 2.0, 0.03);
  command.write = false;
  EXPECT_FALSE(slowed->write(command));
}

// Held for 2 s: braking and run-up cover distance that a standstill would not.
TEST(SimulatedMachine, OperatorStopsAndGoesOn) {
  const Machine machine = mill();
  const auto path = plan(machine, {line(0.0, 0.0, 100.0, 0.0)});
  auto plain = machine_of(machine, path);
  auto held = machine_of(machine, path,
                         {{.time_s = 0.5, .act = OperatorAct::feed_hold},
                          {.time_s = 2.5, .act = OperatorAct::feed_start}});
  const double full = run(*plain, [](const Frame&) {});
  double speed_in_hold = 1.0;
  const double longer = run(*held, [&](const Frame& frame) {
    if (frame.time_s > 1.0 && frame.time_s < 2.4) {
      speed_in_hold = frame.path_speed_mm_s;
    }
  });
  EXPECT_EQ(speed_in_hold, 0.0);
  // The standstill saves what braking and starting cover at less than full speed.
  EXPECT_NEAR(longer - full, 2.0, 0.003);
}

// 50 rev/s² to 95 % of the overridden speed.
TEST(SimulatedMachine, WaitsForTheSpindleAtTheOverriddenSpeed) {
  const Machine machine = mill();
  const auto path = plan(machine, {line(0.0, 0.0, 10.0, 0.0)}, 50.0);
  for (const int percent : {50, 100, 120}) {
    auto sim =
        machine_of(machine, path,
                   {{.time_s = 0.0, .act = OperatorAct::turn_spindle, .code = code_of(percent)}});
    double waited_s = 0.0;
    const double seconds = run(*sim, [&](const Frame& frame) {
      waited_s += frame.motion == Motion::spindle_wait ? 0.001 : 0.0;
    });
    EXPECT_LT(seconds, 10.0);
    EXPECT_NEAR(waited_s, 0.95 * 0.5 * percent / 50.0, 0.02);  // 50 rev/s² to 95 %
    EXPECT_NEAR(sim->truth().spindle_rev_s, 0.5 * percent, 0.03 * percent);
  }
}

// 300 rev/s asked, 200 possible: a machine that waited for the programmed speed would wait forever.
TEST(SimulatedMachine, SpindleThatCannotReachItsSpeedDoesNotHangTheProgram) {
  const Machine machine = mill();  // max 200 rev/s
  auto sim = machine_of(machine, plan(machine, {line(0.0, 0.0, 10.0, 0.0)}, 300.0));
  EXPECT_LT(run(*sim, [](const Frame&) {}), 20.0);
}

}  // namespace
}  // namespace steadyrest::sim
