// SPDX-License-Identifier: Apache-2.0
#include <fmt/format.h>
#include <fmt/ranges.h>

#include <steadyrest/motion/offline/bench/benchmark.hpp>

namespace steadyrest::motion::offline {
namespace {

// Order and names are public: people plot this file. A missing figure is `nan`.
constexpr std::string_view kColumns =
    "scene,estimator,limits,ticks,"
    "velocity_rms_mm_s,velocity_max_mm_s,velocity_own_lag_s,velocity_rms_at_own_lag_mm_s,"
    "velocity_gain,velocity_coverage,velocity_bound_ratio,velocity_efficiency,"
    "acceleration_rms_mm_s2,acceleration_max_mm_s2,acceleration_own_lag_s,"
    "acceleration_rms_at_own_lag_mm_s2,"
    "acceleration_gain,acceleration_coverage,acceleration_bound_ratio,acceleration_efficiency,"
    "contradictions,ns_per_tick,ns_per_edge,target_velocity_mm_s,target_acceleration_mm_s2";

std::string figures(const ErrorFigures& e, double gain, double efficiency) {
  return fmt::format("{:.6g},{:.6g},{:.6g},{:.6g},{:.6g},{:.6g},{:.6g},{:.6g}", e.rms, e.max,
                     e.own_lag_s, e.rms_at_own_lag, gain, e.coverage,
                     e.bound_rms_at_speed / e.rms_at_speed, efficiency);
}

}  // namespace

std::string to_csv(const Benchmark& benchmark) {
  std::string out(kColumns);
  out += '\n';
  for (const BenchRow& row : benchmark.rows) {
    out +=
        fmt::format("{},{},{},{},{},{},{},{:.0f},{:.0f},{:.6g},{:.6g}\n", row.scene, row.estimator,
                    row.limits ? 1 : 0, row.ticks,
                    figures(row.velocity, row.velocity_gain, row.velocity_efficiency),
                    figures(row.acceleration, row.acceleration_gain, row.acceleration_efficiency),
                    row.contradictions, row.ns_per_tick, row.ns_per_edge, row.target_velocity_mm_s,
                    row.target_acceleration_mm_s2);
  }
  return out;
}

}  // namespace steadyrest::motion::offline
