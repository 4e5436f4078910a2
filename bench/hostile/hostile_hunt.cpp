// SPDX-License-Identifier: Apache-2.0
// Hunts for a cycle after which a rule of safety does not hold:
// by default 10⁶ cycles on each machine of examples/machines, run in the project's root.
// One summary line a machine; the first broken rule with seed and cycle, from which it repeats.
#include <algorithm>
#include <cstdint>
#include <string>
#include <vector>

#include <CLI/CLI.hpp>
#include <bench/hostile/hunt.hpp>
#include <fmt/core.h>

#include <steadyrest/passport/file/machine_file.hpp>

int main(int argc, char** argv) {
  using steadyrest::bench::hostile::Tally;
  constexpr std::uint64_t kPart = 500'000;
  CLI::App app{"Hunts for a cycle after which a rule of safety does not hold"};
  std::uint64_t cycles = 1'000'000;
  std::uint64_t seed = 1;
  std::vector<std::string> files;
  app.add_option("cycles", cycles, "on each machine")
      ->check(CLI::PositiveNumber)
      ->capture_default_str();
  app.add_option("seed", seed)->capture_default_str();
  app.add_option("machines", files, "machine files; without them those of examples/machines");
  CLI11_PARSE(app, argc, argv)
  // All examples: Gray and binary switches, latched and not, with and without spindle override.
  if (files.empty()) {
    for (const char* name :
         {"ideal-k50", "lathe-16k20f3", "linuxcnc-mill", "mill-802d", "vmc-840d"}) {
      files.push_back(fmt::format("examples/machines/{}.toml", name));
    }
  }
  std::uint64_t broken = 0;
  for (const std::string& file : files) {
    const auto machine = steadyrest::passport::read(file);
    if (!machine) {
      fmt::print(stderr, "{} cannot be read\n", file);
      return 2;
    }
    Tally all;
    // Parts of half a million cycles, each with its own seeds.
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
