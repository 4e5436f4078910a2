// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <bit>
#include <cmath>
#include <cstdint>
#include <filesystem>
#include <functional>
#include <memory>
#include <vector>

#include <gtest/gtest.h>

#include <steadyrest/kernel/override/gray.hpp>
#include <steadyrest/nc/plan/path/path_builder.hpp>
#include <steadyrest/passport/file/machine_file.hpp>
#include <steadyrest/sim/base/test/switch_code.hpp>
#include <steadyrest/sim/simulated_machine.hpp>

namespace steadyrest::sim {
namespace {

using kernel::machine::Machine;
using kernel::signal::Frame;
using kernel::signal::Motion;
using nc::interpret::Move;
using nc::interpret::MoveKind;
using nc::plan::PlannedPath;
using test::code_of;

constexpr double kF4000_mm_s = 4000.0 / 60.0;

Machine mill() {
  Machine machine;
  for (const char* name : {"X", "Y", "Z"}) {
    kernel::machine::Axis axis;
    axis.name = name;
    axis.encoder.count_mm = 0.0;
    axis.max_acceleration_mm_s2 = 3000.0;
    machine.axes.push_back(axis);
  }
  for (std::uint32_t i = 0; i <= 12; ++i) {
    machine.feed_override.ratio.push_back(0.1 * i);
    machine.feed_override.code.push_back(kernel::override::gray_code(i + 1));
  }
  machine.rapid_override = machine.feed_override;
  machine.spindle_override = machine.feed_override;
  return machine;
}

Move line(double x0, double y0, double x1, double y1) {
  Move move;
  move.kind = MoveKind::linear;
  move.line = 1;
  move.start = {x0, y0};
  move.end = {x1, y1};
  move.feed_mm_s = kF4000_mm_s;
  return move;
}

/// R = 10 mm about the origin, counter-clockwise from (10, 0).
/// Radius and feed of the paper's reference circle.
Move circle(int turns) {
  Move move = line(10.0, 0.0, 10.0, 0.0);
  move.kind = MoveKind::arc;
  move.line = 2;
  move.normal = {0.0, 0.0, 1.0};
  move.turns = turns;
  return move;
}

std::shared_ptr<const PlannedPath> plan(const Machine& machine, const std::vector<Move>& moves,
                                        double spindle_rev_s = 0.0) {
  nc::plan::PathBuilder builder(machine);
  if (spindle_rev_s != 0.0) {
    builder.on_event({nc::interpret::EventKind::spindle, 1, spindle_rev_s});
  }
  for (Move move : moves) {
    move.spindle_rev_s = spindle_rev_s;
    builder.on_move(move);
  }
  auto path = builder.take();
  EXPECT_TRUE(path);
  return std::make_shared<const PlannedPath>(*std::move(path));
}

std::unique_ptr<SimulatedMachine> machine_of(const Machine& machine,
                                             const std::shared_ptr<const PlannedPath>& path,
                                             const std::vector<OperatorAction>& actions = {}) {
  auto made =
      SimulatedMachine::make({.machine = machine, .path = path, .operator_actions = actions});
  EXPECT_TRUE(made) << (made ? "" : made.error().what);
  return *std::move(made);
}

/// Runs to the end of the program; gives the simulated seconds.
double run(SimulatedMachine& machine, const std::function<void(const Frame&)>& look,
           double most_s = 100.0) {
  double time_s = 0.0;
  while (!machine.finished() && time_s < most_s) {
    const auto frame = machine.read();
    time_s = frame->time_s;
    look(*frame);
  }
  return time_s;
}

// R = 10 mm, F4000, k = 50 1/s: ε = 0.0877 mm, Ed = 1.3216 mm (contour reference, closed form).
// Start and stop of the path are left out.
TEST(SimulatedMachine, CutsTheReferenceCircleWithTheClosedFormsError) {
  const Machine machine = mill();
  auto sim = machine_of(machine, plan(machine, {circle(6)}));
  double least = 1.0;
  double most = -1.0;
  double tracking = 0.0;
  const double length = 6.0 * 2.0 * 3.14159265358979 * 10.0;
  run(*sim, [&](const Frame& frame) {
    if (frame.path_position_mm > 0.4 * length && frame.path_position_mm < 0.9 * length) {
      const auto& tool = sim->truth().tool_mm;
      const double error = 10.0 - std::hypot(tool[0], tool[1]);
      least = std::min(least, error);
      most = std::max(most, error);
      tracking = std::hypot(frame.axis[0].following_error_mm, frame.axis[1].following_error_mm);
    }
  });
  EXPECT_NEAR(least, 0.0877, 0.0877 * 0.002);
  EXPECT_NEAR(most, 0.0877, 0.0877 * 0.002);
  EXPECT_NEAR(tracking, 1.3216, 1.3216 * 0.002);
}

// A trapezoid lasts L/v + v/a.
TEST(SimulatedMachine, TakesTheTimeOfTheTrapezoid) {
  const Machine machine = mill();
  auto sim = machine_of(machine, plan(machine, {line(0.0, 0.0, 100.0, 0.0)}));
  const double seconds = run(*sim, [](const Frame&) {});
  EXPECT_NEAR(seconds, 100.0 / kF4000_mm_s + kF4000_mm_s / 3000.0, 0.004);
  for (int i = 0; i < 500; ++i) {
    ASSERT_TRUE(sim->read());
  }
  EXPECT_TRUE(sim->finished());
  EXPECT_NEAR(sim->truth().tool_mm[0], 100.0, 1e-6);
}

// What the contour room rests on: index, length and segment must agree in every frame.
TEST(SimulatedMachine, FrameCarriesThePathAndWhereTheCommandStands) {
  const Machine machine = mill();
  auto sim = machine_of(machine, plan(machine, {line(0.0, 0.0, 10.0, 0.0), circle(1)}));
  std::size_t last = 0;
  run(*sim, [&](const Frame& frame) {
    ASSERT_EQ(frame.path.size(), 2U);
    ASSERT_LT(frame.path_index, 2U);
    ASSERT_GE(frame.path_index, last);
    last = frame.path_index;
    const auto& segment = frame.path[frame.path_index];
    ASSERT_GE(frame.path_position_mm, segment.position_mm - 1e-9);
    ASSERT_LE(frame.path_position_mm, segment.position_mm + segment.length_mm + 1e-9);
    if (frame.motion == Motion::feed) {
      ASSERT_NEAR(frame.programmed_feed_mm_s, kF4000_mm_s, 1e-9);
      ASSERT_EQ(frame.program_line, segment.line);
    }
  });
  EXPECT_EQ(last, 1U);
}

// Half the feed, twice the time, but for acceleration and the override's dead time.
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

// Held for 2 s: braking and run-up cover the way that the standstill would not have.
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
  // What braking and starting cover at less than full speed is what the standstill saves.
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

// 300 rev/s asked, 200 possible: a machine that waited for the programmed speed would wait for
// ever.
TEST(SimulatedMachine, SpindleThatCannotReachItsSpeedDoesNotHangTheProgram) {
  const Machine machine = mill();  // max 200 rev/s
  auto sim = machine_of(machine, plan(machine, {line(0.0, 0.0, 10.0, 0.0)}, 300.0));
  EXPECT_LT(run(*sim, [](const Frame&) {}), 20.0);
}

// Four periods in one layer cycle must end where four cycles of one period end, to the bit.
TEST(SimulatedMachine, ALayerCycleMayBeSeveralPeriods) {
  const Machine machine = mill();
  const auto path = plan(machine, {circle(2)});
  auto fine = machine_of(machine, path);
  auto coarse = *SimulatedMachine::make({.machine = machine, .path = path, .periods_per_cycle = 4});
  for (int i = 0; i < 200; ++i) {
    for (int j = 0; j < 3; ++j) {
      ASSERT_TRUE(fine->read());
    }
    const auto a = fine->read();
    const auto b = coarse->read();
    ASSERT_EQ(a->time_s, b->time_s);
    ASSERT_EQ(a->axis[0].actual_mm, b->axis[0].actual_mm);
  }
}

// Friction, backlash, counts and noise are all in it: any state that is not reset or seeded shows.
TEST(SimulatedMachine, SameSeedSameBytes) {
  Machine machine = mill();
  for (auto& axis : machine.axes) {
    axis.velocity_lag_s = 0.002;
    axis.backlash_mm = 0.004;
    axis.friction = {.coulomb_mm_s2 = 150.0, .breakaway_mm_s2 = 250.0};
    axis.encoder.count_mm = 0.001;
    axis.encoder.line_error_mm = 0.0002;
    axis.encoder.line_period_mm = 0.02;
  }
  machine.simulation.position_noise_mm = 0.0003;
  const auto path = plan(machine, {line(0.0, 0.0, 10.0, 0.0), circle(2)}, 20.0);
  const auto bytes = [&](std::uint64_t seed) {
    machine.simulation.seed = seed;
    auto sim = machine_of(machine, path);
    std::vector<std::uint64_t> out;
    run(*sim, [&](const Frame& frame) {
      for (std::size_t a = 0; a < 3; ++a) {
        out.push_back(std::bit_cast<std::uint64_t>(frame.axis[a].actual_mm));
        out.push_back(std::bit_cast<std::uint64_t>(sim->truth().tool_mm[a]));
      }
    });
    return out;
  };
  const auto first = bytes(1);
  EXPECT_EQ(first, bytes(1));
  EXPECT_NE(first, bytes(2));
}

// Every machine that is shipped: arrives in 25 mm / 10 mm/s = 2.5 s, rests within its own slack.
TEST(SimulatedMachine, EveryExampleMachineArrivesAndComesToRest) {
  int machines = 0;
  for (const auto& file :
       std::filesystem::directory_iterator(STEADYREST_SOURCE_DIR "/examples/machines")) {
    if (file.path().extension() != ".toml") {
      continue;
    }
    ++machines;
    const auto machine = passport::read(file.path().string());
    ASSERT_TRUE(machine) << machine.error().what;
    Move move = line(0.0, 0.0, 20.0, 0.0);
    move.end[2] = -15.0;
    move.feed_mm_s = 10.0;
    auto sim = machine_of(*machine, plan(*machine, {move}));
    const double seconds = run(*sim, [](const Frame&) {});
    EXPECT_NEAR(seconds, 2.5, 0.3) << file.path();
    for (int i = 0; i < 2000; ++i) {
      ASSERT_TRUE(sim->read());
    }
    const double slack_mm = machine->axes[0].backlash_mm / 2.0 + machine->axes[0].encoder.count_mm +
                            machine->axes[0].encoder.line_error_mm +
                            6.0 * machine->simulation.position_noise_mm + 1e-3;
    EXPECT_NEAR(sim->truth().tool_mm[0], 20.0, slack_mm) << file.path();
    if (!machine->axes[1].present) {
      EXPECT_EQ(sim->truth().tool_mm[1], 0.0);
    }
  }
  EXPECT_GE(machines, 4);
}

// No path, no cycle, no axis.
TEST(SimulatedMachine, RefusesWhatItCannotRun) {
  const Machine machine = mill();
  const auto path = plan(machine, {circle(1)});
  EXPECT_FALSE(SimulatedMachine::make({.machine = machine, .path = nullptr}));
  EXPECT_FALSE(SimulatedMachine::make({.machine = machine, .path = path, .periods_per_cycle = 0}));
  EXPECT_FALSE(SimulatedMachine::make({.machine = Machine{}, .path = path}));
}

}  // namespace
}  // namespace steadyrest::sim
