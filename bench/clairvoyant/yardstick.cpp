// SPDX-License-Identifier: Apache-2.0
// Feed governor against the clairvoyant schedule: steadyrest_yardstick PROGRAM MACHINE.toml prints
// a table and one JSON line.
#include <cstdio>
#include <cstdlib>
#include <memory>
#include <string>

#include <bench/clairvoyant/simulated_schedule.hpp>
#include <fmt/core.h>

#include <steadyrest/nc/plan/path/plan_program.hpp>
#include <steadyrest/passport/file/machine_file.hpp>
#include <steadyrest/trial/cut/cut_job.hpp>

namespace steadyrest::bench::clairvoyant {
namespace {

using kernel::machine::Machine;
using trial::cut::Figures;
using trial::cut::Job;

template <class T>
T take(kernel::outcome::Result<T> result) {
  if (!result) {
    fmt::print(stderr, "yardstick: {}\n", kernel::outcome::text(result.error()));
    std::exit(1);
  }
  return std::move(*result);
}

void print_row(const char* name, const Figures& figures, double reference_s) {
  fmt::print("{:<28} {:>9.2f} s {:>8.1f} % {:>9.1f} um {:>9.4f} % over {:>6} changes\n", name,
             figures.cycle_time_s, 100.0 * figures.cycle_time_s / reference_s,
             1e3 * figures.contour_error_max_mm, 100.0 * share_over(figures),
             figures.override_changes);
}

std::shared_ptr<const nc::plan::PlannedPath> read_program(const std::string& file,
                                                          const Machine& machine) {
  nc::interpret::Config config;
  config.dialect = machine.control.dialect;
  return std::make_shared<const nc::plan::PlannedPath>(
      take(nc::plan::plan_file(file, config, machine)));
}

int main_with(const std::string& program, const std::string& machine_file) {
  const Machine machine = take(passport::read(machine_file));
  Job job{.machine = machine, .path = read_program(program, machine)};
  // The lower bound treats changes of speed as immediate; the simulated schedule is achievable. The
  // governor is compared with the latter.
  const Yardstick yardstick =
      take(yardstick_of(job, [](const std::string& line) { fmt::print(stderr, "{}\n", line); }));
  const Figures& clairvoyant = yardstick.figures;
  const Figures without = take(trial::cut::run(job)).figures();
  job.with_layer = true;
  const Figures with = take(trial::cut::run(job)).figures();
  fmt::print("{:<28} {:>9.2f} s (lower bound, {:.3f} s of it over the limit)\n",
             "dynamic programming", yardstick.bound.time_s, yardstick.bound.over_limit_s);
  print_row("clairvoyant, simulated", clairvoyant, clairvoyant.cycle_time_s);
  print_row("governor", with, clairvoyant.cycle_time_s);
  print_row("without the layer", without, clairvoyant.cycle_time_s);
  fmt::print(
      "{{\"clairvoyant_s\": {:.4f}, \"bound_s\": {:.4f}, \"governor_s\": {:.4f}, "
      "\"governor_over_share\": {:.6f}, \"clairvoyant_over_share\": {:.6f}}}\n",
      clairvoyant.cycle_time_s, yardstick.bound.time_s, with.cycle_time_s, share_over(with),
      share_over(clairvoyant));
  return 0;
}

}  // namespace
}  // namespace steadyrest::bench::clairvoyant

int main(int argc, char** argv) {
  if (argc != 3) {
    fmt::print(stderr, "usage: steadyrest_yardstick PROGRAM MACHINE.toml\n");
    return 2;
  }
  return steadyrest::bench::clairvoyant::main_with(argv[1], argv[2]);
}
