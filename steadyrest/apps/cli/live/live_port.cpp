// SPDX-License-Identifier: Apache-2.0
#include <utility>

#include <fmt/core.h>

#include <steadyrest/apps/cli/cut/cut_plan.hpp>
#include <steadyrest/apps/cli/live/linuxcnc_live.hpp>
#include <steadyrest/apps/cli/live/live_port.hpp>
#include <steadyrest/apps/cli/live/repeating_port.hpp>
#include <steadyrest/passport/keys/schema.hpp>
#include <steadyrest/sim/simulated_machine.hpp>

namespace steadyrest::apps::cli::live {
namespace {

std::expected<LivePort, Refusals> simulated(const kernel::machine::Machine& machine,
                                            const ProgramOptions& program, bool repeats) {
  if (program.file.empty()) {
    return refused(bad_input("the simulated machine has nothing to cut", "give --program FILE"));
  }
  const auto planned = cut::plan(program, machine);
  if (!planned) {
    return std::unexpected(planned.error().refusals);
  }
  const auto make = [config =
                         sim::SimulatedMachine::Config{.machine = machine, .path = planned->path}] {
    return sim::SimulatedMachine::make(config);
  };
  LivePort out;
  out.period_s = machine.control.interpolator_period_s;
  if (repeats) {
    auto port = RepeatingPort::open(make);
    if (!port) {
      return refused(port.error());
    }
    out.port = std::move(*port);
    return out;
  }
  auto made = make();
  if (!made) {
    return refused(made.error());
  }
  out.finished = [simulated = made->get()] { return simulated->finished(); };
  out.port = std::move(*made);
  return out;
}

#if STEADYREST_HAS_LINUXCNC
constexpr const char* kPorts = "sim, linuxcnc";
#else
constexpr const char* kPorts = "sim";
#endif

}  // namespace

std::expected<LivePort, Refusals> open_port(const kernel::machine::Machine& machine,
                                            const ProgramOptions& program, bool repeats) {
  if (machine.port == kernel::machine::PortKind::sim) {
    return simulated(machine, program, repeats);
  }
  if (repeats) {
    return refused(bad_input("--repeat is for the simulated machine",
                             "leave it out; a control repeats its program itself"));
  }
#if STEADYREST_HAS_LINUXCNC
  if (machine.port == kernel::machine::PortKind::linuxcnc) {
    return open_linuxcnc(machine, program);
  }
#endif
  return refused(bad_input(machine.file,
                           fmt::format("the port {} is not in this program; allowed: {}",
                                       passport::word(machine.port), kPorts),
                           "set port = \"sim\""));
}

}  // namespace steadyrest::apps::cli::live
