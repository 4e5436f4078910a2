// SPDX-License-Identifier: Apache-2.0
// A control behind an OPC UA server, in real time, for trials of the program as a user tries it:
// steadyrest_opcua_control_server MACHINE.toml PROGRAM SECONDS. Writes a machine file with its
// endpoint, user and password, names it, and ends after the time with one line of JSON.
#include <cstdio>
#include <cstdlib>
#include <string>

#include <fmt/core.h>
#include <tests/opcua/real_time_control.hpp>

#include <steadyrest/kernel/link/event.hpp>
#include <steadyrest/nc/plan/path/plan_program.hpp>
#include <steadyrest/passport/file/machine_file.hpp>

int main(int argc, char** argv) {
  using namespace steadyrest;
  if (argc != 4) {
    fmt::print(stderr, "usage: steadyrest_opcua_control_server MACHINE.toml PROGRAM SECONDS\n");
    return 2;
  }
  const auto machine = passport::read(argv[1]).value();
  nc::interpret::Config interpret;
  interpret.dialect = machine.control.dialect;
  const opcua::RealTimeControl control(
      argv[1], std::make_shared<const nc::plan::PlannedPath>(
                   nc::plan::plan_file(argv[2], interpret, machine).value()));
  fmt::print("{}\n", control.machine_file());
  std::fflush(stdout);
  kernel::link::Event().wait(std::atof(argv[3]));
  const auto seen = control.seen();
  fmt::print(
      "{{\"seconds\": {:.3f}, \"finished\": {}, \"least_feed_ratio\": {:.3f}, "
      "\"obeyed_cycles\": {}, \"feed_in_force\": {:.3f}}}\n",
      seen.time_s, seen.finished, seen.least_feed_ratio, seen.obeyed_cycles, seen.feed_in_force);
  return 0;
}
