// SPDX-License-Identifier: Apache-2.0
// The thermal room in the cycle: one step of the filter, and a cycle of the governor at 1 kHz with
// one and with three axes of two modes and one sensor each (a full machine).
#include <benchmark/benchmark.h>

#include <steadyrest/thermal/online/offset_governor.hpp>

namespace {

using namespace steadyrest;
using thermal::online::OffsetGovernor;
using thermal::online::StateFilter;

kernel::machine::ThermalAxis axis(const char* name) {
  kernel::machine::ThermalAxis axis;
  axis.name = name;
  axis.drift_mm = 0.003;
  axis.mode.resize(2);
  axis.mode[0].tau_s = 900.0;
  axis.mode[0].polynomial_mm = {0.004, 0.0005};
  axis.mode[1].tau_s = 5400.0;
  axis.mode[1].polynomial_mm = {0.010, -0.0003};
  axis.ambient.push_back({.sensor = "room", .tau_s = 3600.0, .gain_mm_k = 0.002});
  return axis;
}

/// Range 0: the step varies, so that every exponential is computed again. Range 1: that many more
/// ambient inputs, of three time constants.
void filter_step(benchmark::State& state) {
  kernel::machine::ThermalAxis z = axis("Z");
  for (std::int64_t j = 0; j < state.range(1); ++j) {
    z.ambient.push_back({.sensor = "t", .tau_s = 3000.0 * static_cast<double>(j % 3)});
  }
  StateFilter filter = StateFilter::make({.axis = z}).value();
  thermal::online::Drive drive;
  drive.ambient_c.fill(21.0);
  double h = 1.0;
  for (auto _ : state) {
    drive.speed_rev_s = drive.speed_rev_s > 90.0 ? 20.0 : drive.speed_rev_s + 0.1;
    h = state.range(0) != 0 ? (h > 1.5 ? 1.0 : h + 1e-4) : h;
    benchmark::DoNotOptimize(filter.update(h, drive));
  }
}
BENCHMARK(filter_step)
    ->ArgNames({"step_varies", "more_inputs"})
    ->Args({0, 0})
    ->Args({1, 0})
    ->Args({0, 48})
    ->Args({1, 48});

/// Range 1: coolant starts and stops in every cycle, so that the filters step in each.
void governor_cycle(benchmark::State& state) {
  kernel::machine::Machine machine;
  machine.axes.resize(3);
  machine.axes[1].name = "Y";
  machine.axes[2].name = "Z";
  machine.thermal.enabled = true;
  for (const char* name : {"X", "Y", "Z"}) {
    if (machine.thermal.axis.size() < static_cast<std::size_t>(state.range(0))) {
      machine.thermal.axis.push_back(axis(name));
    }
  }
  OffsetGovernor governor = OffsetGovernor::make(machine).value();
  kernel::signal::Frame frame;
  frame.motion = kernel::signal::Motion::feed;
  frame.temperature_c.fill(21.0);
  for (auto _ : state) {
    frame.time_s += 0.001;
    frame.spindle_actual_rev_s = frame.spindle_actual_rev_s > 90.0 ? 20.0 : 50.0;
    if (state.range(1) != 0) {
      frame.coolant = !frame.coolant;
    }
    benchmark::DoNotOptimize(governor.update(frame, kernel::outcome::Reason::none, true, {}));
  }
}
BENCHMARK(governor_cycle)
    ->ArgNames({"axes", "steps_in_each"})
    ->Args({1, 0})
    ->Args({3, 0})
    ->Args({1, 1})
    ->Args({3, 1});

}  // namespace
