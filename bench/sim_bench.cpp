// SPDX-License-Identifier: Apache-2.0
/// How much faster than real time the simulated machine runs, from its body alone to a whole
/// program with planner and panel: each benchmark reports `x_real_time`, simulated seconds per
/// second of one core; SimulatedMachine_Cycle the time of one cycle.
#include <algorithm>
#include <chrono>
#include <cmath>
#include <cstdint>
#include <memory>
#include <numbers>
#include <vector>

#include <benchmark/benchmark.h>

#include <steadyrest/kernel/override/gray.hpp>
#include <steadyrest/nc/plan/path/path_builder.hpp>
#include <steadyrest/sim/machine_body.hpp>
#include <steadyrest/sim/simulated_machine.hpp>

namespace {

using steadyrest::kernel::machine::Machine;
using steadyrest::sim::MachineBody;

/// 4000 mm/min, the feed of the paper's arc.
constexpr double kFeed_mm_s = 4000.0 / 60.0;

Machine three_axes() {
  Machine machine;
  // Axes with their defaults and a switch of 13 Gray positions, 0 … 120 %.
  for (const char* name : {"X", "Y", "Z"}) {
    steadyrest::kernel::machine::Axis axis;
    axis.name = name;
    machine.axes.push_back(axis);
  }
  for (std::uint32_t i = 0; i <= 12; ++i) {
    machine.feed_override.ratio.push_back(0.1 * i);
    machine.feed_override.code.push_back(steadyrest::kernel::override::gray_code(i + 1));
  }
  // The delay of a PLC's path, so that the queue of pending words is used.
  machine.feed_override.dead_time_s = 0.03;
  machine.rapid_override = machine.feed_override;
  machine.spindle_override = machine.feed_override;
  return machine;
}

/// Friction, backlash, drive limit, line error, noise.
Machine with_all_on() {
  Machine machine = three_axes();
  for (auto& axis : machine.axes) {
    axis.velocity_lag_s = 0.003;
    axis.drive_acceleration_au_s2 = 4000.0;
    axis.backlash_au = 0.006;
    axis.friction = {
        .coulomb_au_s2 = 200.0, .breakaway_au_s2 = 350.0, .stribeck_au_s = 1.5, .viscous_1_s = 0.5};
    axis.encoder.count_au = 0.001;
    axis.encoder.line_error_au = 0.0003;
    axis.encoder.line_period_au = 0.02;
  }
  machine.simulation.position_noise_mm = 0.0005;
  return machine;
}

/// A helix whose radius changes with each 10 000 cycles: all three axes move, reversals included.
std::vector<steadyrest::nc::plan::Setpoint> setpoints(double period_s) {
  std::vector<steadyrest::nc::plan::Setpoint> all(60000);
  double angle = 0.0;
  for (std::size_t i = 0; i < all.size(); ++i) {
    const double radius = 4.0 + 6.0 * static_cast<double>(i / 10000);
    const double rate = kFeed_mm_s / radius;
    angle += rate * period_s;
    auto& s = all[i];
    s.position = {radius * std::cos(angle), radius * std::sin(angle), 3.0 * std::sin(0.3 * angle)};
    s.velocity = {-kFeed_mm_s * std::sin(angle), kFeed_mm_s * std::cos(angle),
                  0.9 * rate * std::cos(0.3 * angle)};
    s.motion = steadyrest::kernel::signal::Motion::feed;
    s.path_speed_mm_s = kFeed_mm_s;
    s.programmed_feed_mm_s = kFeed_mm_s;
    s.spindle_rev_s = (i / 10000) % 2 == 0 ? 100.0 : 60.0;
  }
  return all;
}

/// The word changes every half second, as a layer at work changes it.
void run_body(benchmark::State& state, const Machine& machine) {
  const auto path = setpoints(machine.control.interpolator_period_s);
  auto body = MachineBody::make({.machine = machine});
  steadyrest::kernel::signal::Command command;
  command.feed_masks_panel = true;
  double sum = 0.0;
  for (auto _ : state) {
    // Every iteration starts at rest, so that they are alike.
    body->reset(path.front().position);
    for (const auto& setpoint : path) {
      ++command.heartbeat;
      command.feed_code = steadyrest::kernel::override::gray_code(
          1U + static_cast<std::uint32_t>(command.heartbeat / 500 % 11));
      sum += body->begin(command).feed_ratio;
      body->end(setpoint);
      sum += body->frame().axis[0].actual_mm;
    }
  }
  benchmark::DoNotOptimize(sum);
  const double simulated_s = static_cast<double>(path.size()) *
                             machine.control.interpolator_period_s *
                             static_cast<double>(state.iterations());
  state.counters["x_real_time"] = benchmark::Counter(simulated_s, benchmark::Counter::kIsRate);
}

using steadyrest::nc::interpret::Move;
using steadyrest::nc::interpret::MoveKind;

/// A pocket with a wavy floor: 0.4 mm lines in x, y and z along a spiral of arcs, a full helix
/// after each turn, with rounded corners and a spindle start.
std::shared_ptr<const steadyrest::nc::plan::PlannedPath> program(const Machine& machine) {
  steadyrest::nc::plan::PathBuilder builder(machine);
  builder.on_event({steadyrest::nc::interpret::EventKind::spindle, 1, 100.0});
  Move move;
  move.feed_mm_s = kFeed_mm_s;
  move.path_tolerance_mm = 0.01;
  move.spindle_rev_s = 100.0;
  move.end = {5.0, 0.0, 0.0};
  const auto go = [&](MoveKind kind, double x, double y, double z) {
    move.kind = kind;
    ++move.line;
    move.start = move.end;
    move.end = {x, y, z};
    builder.on_move(move);
  };
  for (double angle = 0.0; angle < 60.0 * std::numbers::pi;) {
    const double radius = 5.0 + 0.2 * angle;
    angle += 0.4 / radius;
    go(MoveKind::linear, radius * std::cos(angle), radius * std::sin(angle),
       0.5 * std::sin(3.0 * angle));
    if (move.line % 500 == 0) {
      move.centre_mm = {move.end[0] - 4.0, move.end[1], move.end[2]};
      move.normal = {0.0, 0.0, 1.0};
      move.turns = 1;
      go(MoveKind::arc, move.end[0], move.end[1], move.end[2] - 0.3);
    }
  }
  return std::make_shared<const steadyrest::nc::plan::PlannedPath>(builder.take().value());
}

/// The whole machine, planner included, with the layer changing its word ten times in a second.
template <class F>
void run_program(const Machine& machine,
                 const std::shared_ptr<const steadyrest::nc::plan::PlannedPath>& path,
                 F&& each_cycle) {
  auto sim = steadyrest::sim::SimulatedMachine::make({.machine = machine, .path = path}).value();
  steadyrest::kernel::signal::Command command;
  command.write = true;
  command.feed_masks_panel = true;
  while (!sim->finished()) {
    each_cycle(*sim);
    ++command.heartbeat;
    command.feed_code = steadyrest::kernel::override::gray_code(
        6U + static_cast<std::uint32_t>(command.heartbeat / 100 % 6));
    benchmark::DoNotOptimize(sim->write(command));
  }
}

/// x_real_time of a whole program: what `cut` needs for one of its two runs.
void SimulatedMachine_Program(benchmark::State& state) {
  const Machine machine = with_all_on();
  const auto path = program(machine);
  double simulated_s = 0.0;
  for (auto _ : state) {
    double end_s = 0.0;
    run_program(machine, path, [&](auto& sim) { end_s = sim.read()->time_s; });
    simulated_s += end_s;
  }
  state.counters["x_real_time"] = benchmark::Counter(simulated_s, benchmark::Counter::kIsRate);
  state.counters["segments"] = static_cast<double>(path->segments.size());
}
BENCHMARK(SimulatedMachine_Program)->Unit(benchmark::kMillisecond);

/// The distribution over single cycles; the mean of the above hides planning spikes.
void SimulatedMachine_Cycle(benchmark::State& state) {
  using Clock = std::chrono::steady_clock;
  const Machine machine = with_all_on();
  const auto path = program(machine);
  std::vector<double> cycle_us;
  for (auto _ : state) {
    run_program(machine, path, [&](auto& sim) {
      const auto start = Clock::now();
      benchmark::DoNotOptimize(sim.read());
      cycle_us.push_back(std::chrono::duration<double, std::micro>(Clock::now() - start).count());
    });
  }
  // Quantiles over all cycles of all iterations.
  std::ranges::sort(cycle_us);
  const auto share = [&](double q) {
    return cycle_us[static_cast<std::size_t>(q * static_cast<double>(cycle_us.size() - 1))];
  };
  state.counters["median_us"] = share(0.5);
  state.counters["p99.9_us"] = share(0.999);
  state.counters["worst_us"] = cycle_us.back();
}
BENCHMARK(SimulatedMachine_Cycle)->Unit(benchmark::kMillisecond);

void MachineBody_Linear(benchmark::State& state) {
  run_body(state, three_axes());
}
void MachineBody_AllOn(benchmark::State& state) {
  run_body(state, with_all_on());
}
BENCHMARK(MachineBody_Linear)->Unit(benchmark::kMillisecond);
BENCHMARK(MachineBody_AllOn)->Unit(benchmark::kMillisecond);

}  // namespace

BENCHMARK_MAIN();
