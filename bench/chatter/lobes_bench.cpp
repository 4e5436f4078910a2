// SPDX-License-Identifier: Apache-2.0
// Stability maps compared with first-order semi-discretization as in the literature, in one run.
#include <benchmark/benchmark.h>

#include <steadyrest/chatter/offline/cycle/multipliers.hpp>
#include <steadyrest/chatter/offline/depth/limit_depth.hpp>
#include <steadyrest/chatter/offline/depth/lobe_map.hpp>
#include <steadyrest/chatter/offline/test/cuts.hpp>
#include <steadyrest/chatter/offline/test/semi_discretization.hpp>

// The map of the literature's benchmark: the 1-DOF slot of Insperger and Stépán, 922 Hz, two teeth.
namespace steadyrest::chatter {
namespace {

using offline::LobeMapConfig;
using offline::Process;

std::vector<double> even(double from, double to, std::size_t n) {
  std::vector<double> out;
  for (std::size_t i = 0; i < n; ++i) {
    out.push_back(from + (to - from) * static_cast<double>(i) / static_cast<double>(n - 1));
  }
  return out;
}

Process slot() {
  return offline::test::benchmark_cut(1.0, offline::Direction::up);
}

/// 5000…25 000 rpm × 0…10 mm, 200 × 100; threads: the argument.
void slot_map(benchmark::State& state) {
  LobeMapConfig config;
  config.speed_rev_s = even(5000.0 / 60.0, 25000.0 / 60.0, 200);
  config.depth_mm = even(0.0, 10.0, 100);
  config.threads = static_cast<unsigned>(state.range(0));
  for (auto _ : state) {
    benchmark::DoNotOptimize(lobe_map(slot(), config, {}));
  }
}
BENCHMARK(slot_map)
    ->Arg(1)
    ->Arg(2)
    ->Unit(benchmark::kMillisecond)
    ->UseRealTime()
    ->MeasureProcessCPUTime();

/// Only the border: one depth per speed, where the map above needs 100.
void slot_border(benchmark::State& state) {
  for (auto _ : state) {
    for (const double speed : even(5000.0 / 60.0, 25000.0 / 60.0, 200)) {
      offline::DepthTracker tracker(slot(), speed, 10.0);
      benchmark::DoNotOptimize(tracker.border_mm(40));
    }
  }
}
BENCHMARK(slot_border)->Unit(benchmark::kMillisecond);

/// A thousandth of that map, 20 points, by first-order semi-discretization: the usual 40 steps (8 %
/// too low in |μ| at 1 mm, hence an optimistic border) and 100.
void slot_semi_discretization(benchmark::State& state) {
  for (auto _ : state) {
    for (const double speed : even(5000.0 / 60.0, 25000.0 / 60.0, 20)) {
      benchmark::DoNotOptimize(offline::test::radius_by_semi_discretization(
          slot(), speed, 1.0, static_cast<int>(state.range(0))));
    }
  }
}
BENCHMARK(slot_semi_discretization)->Arg(40)->Arg(100)->Unit(benchmark::kMillisecond);

/// x″ + 0.1·x′ + (1 + w)·x = w·x(t − τ) at 100 Hz, the turning benchmark of the Julia packages: 100
/// speeds of 1 to 5 waves a revolution × 100 widths w up to 1, the speed a sine of ten revolutions'
/// period and 10 %. Full width is the one whose cutting stiffness equals the mode's.
void turning_map(benchmark::State& state) {
  Process process;
  process.cut.operation = offline::Operation::turning;
  process.cut.radial_n_mm2 = 1000.0;
  offline::Mode mode;
  mode.frequency_hz = 100.0;
  mode.damping_ratio = 0.05;
  mode.mass_kg = 1.0;
  process.modes = {mode};
  const double stiffness = 1e-3 * 628.3 * 628.3;
  LobeMapConfig config;
  config.speed_rev_s = even(20.0, 100.0, 100);
  config.depth_mm = even(0.0, stiffness / 1000.0, 100);
  config.modulation = {online::Law::sine, 0.1, 0.1, 1};
  config.threads = static_cast<unsigned>(state.range(0));
  for (auto _ : state) {
    benchmark::DoNotOptimize(lobe_map(process, config, {}));
  }
}
BENCHMARK(turning_map)
    ->Arg(1)
    ->Arg(2)
    ->Unit(benchmark::kMillisecond)
    ->UseRealTime()
    ->MeasureProcessCPUTime();

/// One application of the period's map for q tooth passes. It must be O(q): the same pass matrices
/// serve every pass, and only the state is carried on.
void period_of_passes(benchmark::State& state) {
  offline::DelayCycle::Config config;
  config.speed_rev_s = 5000.0 / 60.0;
  config.most_depth_mm = 1.0;
  config.modulation = {online::Law::triangle, 0.2, 2.0 / static_cast<double>(state.range(0)), 1};
  auto cycle = offline::DelayCycle::make(slot(), config).value();
  cycle.set_depth(1.0);
  Eigen::VectorXd vibration = Eigen::VectorXd::Ones(cycle.state_size());
  for (auto _ : state) {
    cycle.apply(vibration);
    // The state would overflow after some thousand periods; only the direction matters.
    vibration.normalize();
    benchmark::DoNotOptimize(vibration.data());
  }
  state.SetComplexityN(state.range(0));
}
BENCHMARK(period_of_passes)
    ->RangeMultiplier(2)
    ->Range(8, 256)
    ->Complexity(benchmark::oN)
    ->Unit(benchmark::kMicrosecond);

/// The whole answer, from building the map to ln ρ: the cost of `chatter radius`.
void radius_of_passes(benchmark::State& state) {
  for (auto _ : state) {
    offline::DelayCycle::Config config;
    config.speed_rev_s = 5000.0 / 60.0;
    config.most_depth_mm = 1.0;
    config.modulation = {online::Law::triangle, 0.2, 2.0 / static_cast<double>(state.range(0)), 1};
    auto cycle = offline::DelayCycle::make(slot(), config).value();
    cycle.set_depth(1.0);
    benchmark::DoNotOptimize(offline::multipliers(cycle, 1).log_modulus[0]);
  }
}
BENCHMARK(radius_of_passes)->RangeMultiplier(2)->Range(8, 256)->Unit(benchmark::kMillisecond);

}  // namespace
}  // namespace steadyrest::chatter
