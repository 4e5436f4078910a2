// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <bit>
#include <cmath>
#include <cstdint>
#include <filesystem>
#include <vector>

#include <gtest/gtest.h>

#include <steadyrest/passport/file/machine_file.hpp>
#include <steadyrest/sim/simulated_machine.hpp>
#include <steadyrest/sim/test/milled.hpp>

namespace steadyrest::sim {
namespace {

using kernel::machine::Machine;
using kernel::signal::Frame;
using kernel::signal::Motion;
using nc::interpret::Move;
using test::circle;
using test::kF4000_mm_s;
using test::line;
using test::machine_of;
using test::mill;
using test::plan;
using test::run;

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

// The contour room depends on this: index, length and segment must agree in every frame.
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

// The port of the machine file says how often the layer looks: it then sees, to the bit, what it
// would see of every period, in those in which its own cycle ends. 2.5 periods end in the third and
// the fifth; a layer faster than the interpolator looks in every one.
TEST(SimulatedMachine, TheLayersCycleIsThatOfItsPort) {
  Machine machine = mill();
  const double period_s = machine.control.interpolator_period_s;
  const auto path = plan(machine, {circle(2)});
  for (const double periods : {0.5, 1.0, 2.5, 4.0, 5.0}) {
    for (const auto port : {kernel::machine::PortKind::opcua, kernel::machine::PortKind::lines}) {
      auto every = machine_of(machine, path);
      Machine slow = machine;
      slow.port = port;
      slow.opcua.cycle_s = slow.lines.cycle_s = periods * period_s;
      auto seldom = machine_of(slow, path);
      for (int cycle = 1; cycle < 200; ++cycle) {
        const auto seen = seldom->read();
        const double due = std::ceil(cycle * std::max(1.0, periods) - 1e-6) * period_s;
        ASSERT_NEAR(seen->time_s, due, 1e-9) << periods;
        auto a = every->read();
        while (a->time_s < seen->time_s) {
          a = every->read();
        }
        ASSERT_EQ(a->time_s, seen->time_s);
        ASSERT_EQ(a->axis[0].actual_mm, seen->axis[0].actual_mm);
      }
    }
  }
}

// Friction, backlash, counts and noise are all included: any state not reset or seeded shows.
TEST(SimulatedMachine, SameSeedSameBytes) {
  Machine machine = mill();
  for (auto& axis : machine.axes) {
    axis.velocity_lag_s = 0.002;
    axis.backlash_au = 0.004;
    axis.friction = {.coulomb_au_s2 = 150.0, .breakaway_au_s2 = 250.0};
    axis.encoder.count_au = 0.001;
    axis.encoder.line_error_au = 0.0002;
    axis.encoder.line_period_au = 0.02;
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

// Every machine we ship: arrives in 25 mm / 10 mm/s = 2.5 s, rests within its own slack.
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
    const double slack_mm = machine->axes[0].backlash_au / 2.0 + machine->axes[0].encoder.count_au +
                            machine->axes[0].encoder.line_error_au +
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
  EXPECT_FALSE(SimulatedMachine::make({.machine = Machine{}, .path = path}));
}

}  // namespace
}  // namespace steadyrest::sim
