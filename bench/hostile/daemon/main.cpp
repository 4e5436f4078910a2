// SPDX-License-Identifier: Apache-2.0
// Random hostile input through the running loop with all rooms on: by default 10⁷ cycles.
#include <algorithm>
#include <chrono>
#include <cstdint>
#include <string>
#include <vector>

#include <CLI/CLI.hpp>
#include <bench/hostile/daemon/daemon_hunt.hpp>
#include <fmt/core.h>
#include <sys/resource.h>

int main(int argc, char** argv) {
  using namespace steadyrest::bench::hostile;
  CLI::App app{"Random hostile input through the running loop with all rooms on"};
  std::uint64_t cycles = 10'000'000;
  std::uint64_t seed = 1;
  std::uint64_t scene = 4000;
  std::vector<std::string> machines{"vmc-840d", "linuxcnc-mill"};
  app.add_option("cycles", cycles, "in all")->check(CLI::PositiveNumber)->capture_default_str();
  app.add_option("seed", seed)->capture_default_str();
  app.add_option("--scene", scene, "cycles between two starts of the layer")->capture_default_str();
  app.add_option("--machine", machines, "of examples/machines")->capture_default_str();
  CLI11_PARSE(app, argc, argv)
  DaemonTally all;
  const auto begin = std::chrono::steady_clock::now();
  // Parts, so that progress and memory show.
  constexpr std::uint64_t kPart = 50'000;
  for (std::uint64_t part = 0; all.cycles < cycles; ++part) {
    const DaemonTally more = hunt({.machine = machines[part % machines.size()],
                                   .seed = seed + 1'000'000 * part,
                                   .cycles = std::min(kPart, cycles - all.cycles),
                                   .scene = scene});
    if (!more.first.empty()) {
      fmt::print("{}\n", more.first);
    }
    all.add(more);
    rusage used{};
    ::getrusage(RUSAGE_SELF, &used);
    fmt::print(stderr, "{:.1f} %, at most {} KiB\n",
               100.0 * static_cast<double>(all.cycles) / static_cast<double>(cycles),
               used.ru_maxrss);
  }
  const std::chrono::duration<double> took = std::chrono::steady_clock::now() - begin;
  fmt::print(
      "{} cycles in {:.0f} s: {} written, {} masked, {} changes, {} reads and writes failed, {} "
      "answers, {} scenes with a broken law\n",
      all.cycles, took.count(), all.written, all.masked, all.moved, all.failed, all.asked,
      all.broken);
  return all.broken == 0 ? 0 : 1;
}
