// SPDX-License-Identifier: Apache-2.0
#include <bench/hostile/hunt.hpp>
#include <bench/hostile/scene.hpp>

namespace steadyrest::bench::hostile {

void Tally::add(const Tally& other) {
  cycles += other.cycles;
  written += other.written;
  masked += other.masked;
  moved += other.moved;
  held += other.held;
  interrupted += other.interrupted;
  broken += other.broken;
  first = first.empty() ? other.first : first;
}

Tally hunt(const kernel::machine::Machine& machine, std::uint64_t seed, std::uint64_t cycles) {
  // Forty acts, then another machine: most faults show within a few.
  constexpr int kActs = 40;
  Tally all;
  while (all.cycles < cycles) {
    all.add(Scene(machine, seed++).run(kActs));
  }
  return all;
}

}  // namespace steadyrest::bench::hostile
