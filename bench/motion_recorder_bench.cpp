// SPDX-License-Identifier: Apache-2.0
// Cost of the recorder: per A/B sample, per latched read, per edge handed to an estimator, and of
// the cycle monitor per tick. Inputs are recorded walks, so branches are as unpredictable as on a
// machine; `Empty` replays the same walk without a decoder. Time is per item (see
// items_per_second).
#include <cstdint>
#include <random>
#include <vector>

#include <benchmark/benchmark.h>

#include <steadyrest/motion/online/edges/cycle_monitor.hpp>
#include <steadyrest/motion/online/edges/edge_inputs.hpp>
#include <steadyrest/motion/online/edges/edge_ring.hpp>
#include <steadyrest/motion/online/edges/edge_stream.hpp>
#include <steadyrest/motion/online/edges/quadrature_decoder.hpp>

namespace steadyrest::motion::online {
namespace {

struct Sample {
  bool a, b;
};

constexpr std::size_t kItems = 1U << 16U;

/// One edge in `spacing` samples on average, one in four of them a turn. The cell runs through 00,
/// 10, 11, 01: Gray code, so one channel changes at a time.
std::vector<Sample> levels(unsigned spacing) {
  std::mt19937 random(1);
  std::vector<Sample> out;
  unsigned cell = 0;
  unsigned step = 1;
  for (std::size_t i = 0; i < kItems; ++i) {
    if (random() % spacing == 0) {
      step = random() % 4 == 0 ? 4U - step : step;
      cell = (cell + step) & 3U;
    }
    out.push_back({cell == 1U || cell == 2U, cell >= 2U});
  }
  return out;
}

/// The walk without a decoder: the cost of the loop and of reading a sample.
void Empty(benchmark::State& state) {
  const auto samples = levels(static_cast<unsigned>(state.range(0)));
  for ([[maybe_unused]] auto _ : state) {
    unsigned sum = 0;
    for (const Sample& s : samples) {
      sum += s.a != s.b ? 1U : 0U;
      benchmark::DoNotOptimize(sum);
    }
  }
  state.SetItemsProcessed(state.iterations() * static_cast<std::int64_t>(kItems));
}

void SampledLevels(benchmark::State& state) {
  const auto samples = levels(static_cast<unsigned>(state.range(0)));
  QuadratureDecoder decoder(
      {.clock_bits = 32, .hold_samples = static_cast<std::uint16_t>(state.range(1))});
  EdgeRing<64> ring;
  EdgeEvent event;
  std::uint64_t clock = 0;
  // The clock runs on over the iterations; the decoder must cope with its wrap.
  for ([[maybe_unused]] auto _ : state) {
    for (const Sample& s : samples) {
      if (decoder.update(s.a, s.b, clock++, event)) {
        ring.push(event);
      }
    }
    benchmark::DoNotOptimize(ring);
  }
  state.SetItemsProcessed(state.iterations() * static_cast<std::int64_t>(kItems));
}

/// 0 … 7 counts a cycle of 2000 clock ticks, dither among them; 16-bit count and stamp as hostmot2
/// latches them, wrap included.
std::vector<LatchedRead> reads() {
  std::mt19937 random(2);
  std::vector<LatchedRead> out;
  std::uint64_t count = 0;
  std::uint64_t clock = 0;
  std::uint64_t stamp = 0;
  for (std::size_t i = 0; i < kItems; ++i) {
    clock += 2000;
    const auto kind = static_cast<unsigned>(random() % 10);
    count += kind < 8 ? kind : 0U;
    stamp = kind != 0 ? clock - random() % 1900 : stamp;
    out.push_back(
        {.count = count & 0xFFFFU, .stamp = stamp & 0xFFFFU, .clock = clock & 0xFFFFU, .cycle = i});
  }
  return out;
}

void LatchedReads(benchmark::State& state) {
  const auto inputs = reads();
  LatchedDecoder decoder(hostmot2_config(2000));
  EdgeEvent event;
  std::uint64_t events = 0;
  for ([[maybe_unused]] auto _ : state) {
    for (const LatchedRead& read : inputs) {
      events += decoder.update(read, event) ? 1U : 0U;
      benchmark::DoNotOptimize(event);
    }
  }
  benchmark::DoNotOptimize(events);
  state.SetItemsProcessed(state.iterations() * static_cast<std::int64_t>(kItems));
}

/// With a periodic table each line number is reduced to one revolution first.
void EventsToEdges(benchmark::State& state) {
  std::vector<double> errors(1024, 1e-5);
  auto stream =
      EdgeStream::make({.line_error_mm = errors, .periodic = state.range(0) != 0}).value();
  EdgeEvent event;
  for ([[maybe_unused]] auto _ : state) {
    for (std::size_t i = 0; i < kItems; ++i) {
      ++event.line;
      event.ticks += 100;
      auto edge = stream.edge(event);
      benchmark::DoNotOptimize(edge);
    }
  }
  state.SetItemsProcessed(state.iterations() * static_cast<std::int64_t>(kItems));
}

void MonitoredTicks(benchmark::State& state) {
  auto monitor = CycleMonitor::make({.nominal_period_s = 1e-3}).value();
  std::mt19937 random(3);
  // 2 µs of jitter on 1 ms, as on a tuned PREEMPT_RT kernel.
  std::normal_distribution<double> jitter(0.0, 2e-6);
  std::vector<double> wander(kItems);
  for (double& w : wander) {
    w = jitter(random);
  }
  double t = 0.0;
  for ([[maybe_unused]] auto _ : state) {
    for (const double w : wander) {
      t += 1e-3;
      monitor.update(t + w);
    }
  }
  benchmark::DoNotOptimize(monitor.report());
  state.SetItemsProcessed(state.iterations() * static_cast<std::int64_t>(kItems));
}

BENCHMARK(Empty)->Arg(2)->Arg(20);
BENCHMARK(SampledLevels)->ArgNames({"spacing", "hold"})->Args({2, 1})->Args({20, 1})->Args({20, 3});
BENCHMARK(LatchedReads);
BENCHMARK(EventsToEdges)->ArgName("periodic")->Arg(0)->Arg(1);
BENCHMARK(MonitoredTicks);

}  // namespace
}  // namespace steadyrest::motion::online
