// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <functional>
#include <memory>
#include <vector>

#include <gtest/gtest.h>

#include <steadyrest/kernel/override/gray.hpp>
#include <steadyrest/nc/plan/path/path_builder.hpp>
#include <steadyrest/sim/simulated_machine.hpp>

/// A simulated mill and the paths that it runs.
namespace steadyrest::sim::test {

using kernel::machine::Machine;
using kernel::signal::Frame;
using nc::interpret::Move;
using nc::interpret::MoveKind;
using nc::plan::PlannedPath;

inline constexpr double kF4000_mm_s = 4000.0 / 60.0;

inline Machine mill() {
  Machine machine;
  for (const char* name : {"X", "Y", "Z"}) {
    kernel::machine::Axis axis;
    axis.name = name;
    axis.encoder.count_au = 0.0;
    axis.max_acceleration_au_s2 = 3000.0;
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

inline Move line(double x0, double y0, double x1, double y1) {
  Move move;
  move.kind = MoveKind::linear;
  move.line = 1;
  move.start = {x0, y0};
  move.end = {x1, y1};
  move.feed_mm_s = kF4000_mm_s;
  return move;
}

/// R = 10 mm about the origin, counter-clockwise from (10, 0): radius and feed of the paper's
/// reference circle.
inline Move circle(int turns) {
  Move move = line(10.0, 0.0, 10.0, 0.0);
  move.kind = MoveKind::arc;
  move.line = 2;
  move.normal = {0.0, 0.0, 1.0};
  move.turns = turns;
  return move;
}

inline std::shared_ptr<const PlannedPath> plan(const Machine& machine,
                                               const std::vector<Move>& moves,
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

inline std::unique_ptr<SimulatedMachine> machine_of(
    const Machine& machine, const std::shared_ptr<const PlannedPath>& path,
    const std::vector<OperatorAction>& actions = {}) {
  auto made =
      SimulatedMachine::make({.machine = machine, .path = path, .operator_actions = actions});
  EXPECT_TRUE(made) << (made ? "" : made.error().what);
  return *std::move(made);
}

/// Runs to the end of the program; returns the simulated seconds.
inline double run(SimulatedMachine& machine, const std::function<void(const Frame&)>& look,
                  double most_s = 100.0) {
  double time_s = 0.0;
  while (!machine.finished() && time_s < most_s) {
    const auto frame = machine.read();
    time_s = frame->time_s;
    look(*frame);
  }
  return time_s;
}

}  // namespace steadyrest::sim::test
