// SPDX-License-Identifier: Apache-2.0
#include <cmath>

#include <gtest/gtest.h>

#include <steadyrest/sim/heat/test/growing_axes.hpp>
#include <steadyrest/sim/machine_body.hpp>

namespace steadyrest::sim {
namespace {

using test::kMinute;
using test::paper;

kernel::machine::Machine growing_machine() {
  kernel::machine::Machine machine;
  for (const char* name : {"X", "Y", "Z"}) {
    kernel::machine::Axis axis;
    axis.name = name;
    axis.encoder.count_au = 0.0;
    machine.axes.push_back(axis);
  }
  machine.spindle.acceleration_rev_s2 = 20.0;
  machine.thermal = paper();
  machine.thermal.axis[0].mode[0].tau_s = kMinute;
  machine.thermal.axis.push_back(machine.thermal.axis[0]);
  machine.thermal.axis[1].name = "tilt";  // no axis is moved by it
  return machine;
}

/// Ten seconds at 1000 rev/min.
MachineBody warmed(double offset_mm) {
  auto body = MachineBody::make({.machine = growing_machine()});
  EXPECT_TRUE(body);
  body->reset({1.0, 2.0, 3.0});
  kernel::signal::Command command;
  nc::plan::Setpoint stands;
  stands.position = {1.0, 2.0, 3.0};
  stands.spindle_rev_s = 1000.0 / 60.0;
  for (int i = 0; i < 10000; ++i) {
    ++command.heartbeat;
    command.offset_mm[2] = offset_mm;
    body->begin(command);
    body->end(stands);
  }
  return *std::move(body);
}

// Ten seconds at a time constant of a minute, by the step response; the control sees none of it.
TEST(MachineBody, HeatMovesTheToolAndNoEncoderSeesIt) {
  const MachineBody body = warmed(0.0);
  const double grown = 0.0352245 * (1.0 - std::exp(-10.0 / 60.0));
  // The spindle takes 0.8 s to reach its speed, and heats less until then.
  EXPECT_LT(body.truth().tool_mm[2], 3.0 + grown);
  EXPECT_NEAR(body.truth().tool_mm[2], 3.0 + grown, 0.1 * grown);
  EXPECT_NEAR(body.truth().heat_mm[2], body.truth().tool_mm[2] - 3.0, 1e-12);
  EXPECT_EQ(body.truth().tool_mm[0], 1.0);
  EXPECT_EQ(body.frame().axis[2].actual_mm, 3.0);
  EXPECT_EQ(body.frame().axis[2].following_error_mm, 0.0);
}

// The coolant's ratio acts on the level, so it scales the whole growth.
TEST(MachineBody, CoolantThatTheProgramOpensFlowsAndCools) {
  kernel::machine::Machine machine = growing_machine();
  machine.thermal.axis[0].mode[0].coolant_ratio = 0.25;
  const auto grown_mm = [&](bool coolant) {
    auto body = MachineBody::make({.machine = machine});
    EXPECT_TRUE(body);
    body->reset({});
    nc::plan::Setpoint turns;
    turns.spindle_rev_s = 1000.0 / 60.0;
    turns.coolant = coolant;
    for (int i = 0; i < 10000; ++i) {
      body->begin({});
      body->end(turns);
    }
    EXPECT_EQ(body->frame().coolant, coolant);
    return body->truth().heat_mm[2];
  };
  EXPECT_NEAR(grown_mm(true), 0.25 * grown_mm(false), 1e-9);
}

// A reading belongs to the end of a probing move and to the axis that it moved furthest, and
// includes heat and offset; a second probing move right after ends the first one.
TEST(MachineBody, AtItsEndAProbingMoveReadsWhatHeatAndOffsetHaveLeft) {
  using kernel::signal::Motion;
  MachineBody body = warmed(0.0);
  EXPECT_EQ(body.frame().probe.number, 0U);
  nc::plan::Setpoint moves;
  moves.position = {1.0, 2.0, 3.0};
  kernel::signal::Command command;
  command.heartbeat = 20'000;
  command.offset_mm[2] = -0.001;
  const auto go = [&](Motion motion, std::size_t index, double x_mm, double z_mm) {
    moves.motion = motion;
    moves.path_index = index;
    for (int i = 0; i < 200; ++i) {
      moves.position[0] += (x_mm - moves.position[0]) / (200 - i);
      moves.position[2] += (z_mm - moves.position[2]) / (200 - i);
      ++command.heartbeat;
      body.begin(command);
      body.end(moves);
    }
    return body.frame().probe;
  };
  go(Motion::rapid, 0, 1.0, 4.0);
  EXPECT_EQ(go(Motion::probe, 1, 1.1, 3.0).number, 0U) << "not before its end";
  const auto first = go(Motion::rapid, 2, 1.0, 4.0);
  EXPECT_EQ(first.number, 1U);
  EXPECT_EQ(first.axis, 2U) << "what it moved furthest";
  EXPECT_NEAR(first.displacement_mm, body.truth().heat_mm[2] - 0.001, 1e-4)
      << "except for the heat since";
  EXPECT_EQ(first.sd_mm, 0.0);
  go(Motion::probe, 3, 1.0, 3.0);
  EXPECT_EQ(go(Motion::probe, 4, 1.0, 2.0).number, 2U) << "one behind the other";
  EXPECT_EQ(go(Motion::rapid, 5, 1.0, 4.0).number, 3U);
  go(Motion::probe, 6, 9.0, 3.0);
  EXPECT_EQ(go(Motion::rapid, 7, 1.0, 4.0).number, 3U) << "X does not grow";
}

// Two sensors with independent noise; a third one that the machine lacks reads NaN.
TEST(MachineBody, ItsSensorsHangInTheRoom) {
  kernel::machine::Machine machine = growing_machine();
  EXPECT_TRUE(std::isnan(MachineBody::make({.machine = machine})->frame().temperature_c[0]));
  machine.thermal.axis[0].ambient.resize(2);
  machine.thermal.axis[0].ambient[1].sensor = "column";
  machine.simulation.room_c = 23.5;
  machine.simulation.sensor_noise_k = 0.1;
  const auto frame = MachineBody::make({.machine = machine})->frame();
  EXPECT_NEAR(frame.temperature_c[0], 23.5, 0.5);
  EXPECT_NEAR(frame.temperature_c[1], 23.5, 0.5);
  EXPECT_NE(frame.temperature_c[0], frame.temperature_c[1]);
  EXPECT_TRUE(std::isnan(frame.temperature_c[2]));
}

// Heat and offset add up at the tool: the opposite offset brings it back to its place.
TEST(MachineBody, AnAxisOffsetOfTheLayerTakesTheGrowthAway) {
  const double grown_mm = warmed(0.0).truth().heat_mm[2];
  const MachineBody body = warmed(-grown_mm);
  EXPECT_NEAR(body.truth().tool_mm[2], 3.0, 1e-6);
}

}  // namespace
}  // namespace steadyrest::sim
