// SPDX-License-Identifier: Apache-2.0
// Hunts for a cycle after which a rule of safety does not hold:
//   steadyrest_hostile_hunt [CYCLES [SEED [MACHINE…]]]
// By default 10⁶ cycles on each machine of examples/machines, run in the project's root.
#include <algorithm>
#include <cstdint>
#include <cstdlib>
#include <string>
#include <vector>

#include <bench/hostile/hunt.hpp>
#include <fmt/core.h>

#include <steadyrest/kernel/machine/machine_file.hpp>

int main(int argc, char** argv) {
  using steadyrest::bench::hostile::Tally;
  constexpr std::uint64_t kPart = 500'000;
  const std::uint64_t cycles = argc > 1 ? std::strtoull(argv[1], nullptr, 10) : 1'000'000ULL;
  const std::uint64_t seed = argc > 2 ? std::strtoull(argv[2], nullptr, 10) : 1;
  std::vector<std::string> files(argv + std::min(argc, 3), argv + argc);
  if (files.empty()) {
    for (const char* name :
         {"ideal-k50", "lathe-16k20f3", "linuxcnc-mill", "mill-802d", "vmc-840d"}) {
      files.push_back(fmt::format("examples/machines/{}.toml", name));
    }
  }
  std::uint64_t broken = 0;
  for (const std::string& file : files) {
    const auto machine = steadyrest::kernel::machine::read(file);
    if (!machine) {
      fmt::print(stderr, "{} cannot be read\n", file);
      return 2;
    }
    Tally all;
    for (std::uint64_t part = 0; all.cycles < cycles; ++part) {
      const Tally more = steadyrest::bench::hostile::hunt(*machine, seed + 1'000'000 * part,
                                                          std::min(kPart, cycles - all.cycles));
      if (!more.first.empty()) {
        fmt::print("{}\n", more.first);
      }
      all.add(more);
      fmt::print(stderr, "{}: {:.1f} %\n", machine->name,
                 100.0 * static_cast<double>(all.cycles) / static_cast<double>(cycles));
    }
    fmt::print(
        "{}: {} cycles, {} written, {} masked, {} steps, {} held in threads, {} "
        "interruptions: {} scenes broken\n",
        machine->name, all.cycles, all.written, all.masked, all.moved, all.held, all.interrupted,
        all.broken);
    broken += all.broken;
  }
  return broken == 0 ? 0 : 1;
}
