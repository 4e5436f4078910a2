// SPDX-License-Identifier: Apache-2.0
// Hunts for a tick at which the guaranteed bounds of motion do not hold: steadyrest_bound_hunt
// [TICKS] [SEED].
// A broken bound is reported with its seed.
#include <cstdint>
#include <cstdlib>

#include <fmt/core.h>

#include <steadyrest/motion/offline/bench/bound_hunt.hpp>

int main(int argc, char** argv) {
  const std::uint64_t ticks = argc > 1 ? std::strtoull(argv[1], nullptr, 10) : 100'000'000ULL;
  std::uint64_t seed = argc > 2 ? std::strtoull(argv[2], nullptr, 10) : 1;
  steadyrest::motion::offline::Hunt all;
  while (all.ticks < ticks) {
    const auto part = steadyrest::motion::offline::hunt_bounds(seed, 1'000'000);
    seed += part.records;
    all.ticks += part.ticks;
    all.records += part.records;
    all.velocity_outside += part.velocity_outside;
    all.acceleration_outside += part.acceleration_outside;
    all.position_outside += part.position_outside;
    all.contradictions += part.contradictions;
    if (!part.first.empty()) {
      fmt::print("{}\n", part.first);
    }
    fmt::print(stderr, "{:.0f} % \r",
               100.0 * static_cast<double>(all.ticks) / static_cast<double>(ticks));
    if (part.records == 0) {
      break;
    }
  }
  fmt::print(
      "{} ticks in {} records: outside of their bound {} velocities, {} accelerations, {} "
      "positions; {} contradictions\n",
      all.ticks, all.records, all.velocity_outside, all.acceleration_outside, all.position_outside,
      all.contradictions);
  return all.velocity_outside + all.acceleration_outside + all.position_outside == 0 ? 0 : 1;
}
