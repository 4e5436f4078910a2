// SPDX-License-Identifier: Apache-2.0
#include <utility>

#include <fmt/core.h>

#include <steadyrest/apps/cli/cut/cut_plan.hpp>
#include <steadyrest/apps/cli/live/linuxcnc_live.hpp>
#include <steadyrest/apps/cli/live/live_port.hpp>
#include <steadyrest/passport/keys/schema.hpp>
#include <steadyrest/sim/simulated_machine.hpp>

namespace steadyrest::apps::cli::live {
namespace {

std::expected<LivePort, Refusals> simulated(const kernel::machine::Machine& machine,
                                            const ProgramOptions& program) {
  if (program.file.empty()) {
    return refused(bad_input("the simulated machine has nothing to cut", "give --program FILE"));
  }
  const auto planned = cut::plan(program, machine);
  if (!planned) {
    return std::unexpected(planned.error().refusals);
  }
  auto made = sim::SimulatedMachine::make({.machine = machine, .path = planned->path});
  if (!made) {
    return refused(made.error());
  }
  LivePort out;
  out.period_s = machine.control.interpolator_period_s;
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
                                            const ProgramOptions& program) {
  if (machine.port == kernel::machine::PortKind::sim) {
    return simulated(machine, program);
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
