// SPDX-License-Identifier: Apache-2.0
/// How much faster than real time a cut is simulated on one core: `x_real_time`, by processor time.
#include <cstddef>

#include <benchmark/benchmark.h>

#include <steadyrest/sim/cut/cutting_process.hpp>

namespace {

using steadyrest::sim::Cutting;
using steadyrest::sim::CuttingProcess;

/// Two modes, three teeth, 6000 rpm: the 2-DOF case common in the literature, 600 and 660 Hz. Args:
/// helix in degrees, steps per period of the fastest mode, 1 for a modulated speed.
void Cutting_TwoModes(benchmark::State& state) {
  // The stiffness of 5600 N/mm is in the masses: m = k/ω².
  Cutting cut;
  cut.modes = {{{1.0, 0.0}, 600.0, 0.035, 0.394}, {{0.0, 1.0}, 660.0, 0.035, 0.326}};
  cut.teeth = 3;
  cut.diameter_mm = 19.0;
  cut.exit_rad = 1.5707963267948966;
  cut.depth_mm = 3.0;
  cut.helix_rad = static_cast<double>(state.range(0)) * 0.017453292519943295;
  CuttingProcess process =
      CuttingProcess::make({.cut = cut,
                            .slowest_rev_s = 100.0,
                            .steps_per_period = static_cast<double>(state.range(1))})
          .value();
  double simulated_s = 0.0;
  std::size_t i = 0;
  const double sweep = state.range(2) == 0 ? 0.0 : 0.01;
  for (auto _ : state) {
    const double speed = 100.0 + sweep * static_cast<double>(i++ % 1000);
    const auto out = process.step({.speed_rev_s = speed, .feed_per_tooth_mm = 0.1});
    benchmark::DoNotOptimize(out.displacement_mm[0]);
    simulated_s += out.period_s;
  }
  state.counters["x_real_time"] = benchmark::Counter(simulated_s, benchmark::Counter::kIsRate);
  state.counters["slices"] = static_cast<double>(process.slices());
}
BENCHMARK(Cutting_TwoModes)
    ->ArgNames({"helix_deg", "steps_per_period", "modulated"})
    ->Args({0, 40, 0})
    ->Args({0, 20, 0})
    ->Args({0, 40, 1})
    ->Args({30, 40, 0})
    ->Args({30, 40, 1});

}  // namespace
