// SPDX-License-Identifier: Apache-2.0
// Cost of the line table per edge: learning, and only looking up, on a sine with line errors.
// `Lookup` is the baseline. Time is per edge (see items_per_second).
#include <benchmark/benchmark.h>

#include <steadyrest/motion/offline/scene/scene.hpp>
#include <steadyrest/motion/online/line/line_table.hpp>

namespace steadyrest::motion::online {
namespace {

const offline::Record& moves() {
  static const offline::Record record = [] {
    offline::Recording how;
    how.phase_error_counts = 0.05;
    how.line_error_counts = 0.02;
    return offline::record(offline::sine(1.0, 2.0, 2.0), how);
  }();
  return record;
}

LineTable table() {
  return LineTable::make({.first_line = -10, .lines = 2100}).value();
}

void Lookup(benchmark::State& state) {
  // Learnt once, so that the table has what a lookup reads.
  LineTable lines = table();
  for (const Edge& edge : moves().edges) {
    lines.learn(edge.t_s, edge.line, edge.direction, false);
  }
  for ([[maybe_unused]] auto _ : state) {
    double sum = 0.0;
    for (const Edge& edge : moves().edges) {
      sum += lines.position_mm(edge.line) + static_cast<double>(lines.sigma_mm(edge.line));
    }
    benchmark::DoNotOptimize(sum);
  }
  state.SetItemsProcessed(state.iterations() * static_cast<std::int64_t>(moves().edges.size()));
}

void Learn(benchmark::State& state) {
  LineTable lines = table();
  for ([[maybe_unused]] auto _ : state) {
    bool first = true;
    for (const Edge& edge : moves().edges) {
      lines.learn(edge.t_s, edge.line, edge.direction, first);
      first = false;
    }
    benchmark::DoNotOptimize(lines);
  }
  state.SetItemsProcessed(state.iterations() * static_cast<std::int64_t>(moves().edges.size()));
}

BENCHMARK(Lookup);
BENCHMARK(Learn);

}  // namespace
}  // namespace steadyrest::motion::online
