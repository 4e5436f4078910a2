// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <cstddef>
#include <utility>

#include <fmt/core.h>
#include <unistd.h>

#if STEADYREST_HAS_LINUXCNC
#include <steadyrest/adapters/linuxcnc/hal_process.hpp>
#include <steadyrest/adapters/linuxcnc/linuxcnc_port.hpp>
#endif
#include <steadyrest/apps/cli/cut/cut_plan.hpp>
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
std::expected<LivePort, Refusals> linuxcnc(const kernel::machine::Machine& machine,
                                           const ProgramOptions& program) {
  if (!program.file.empty()) {
    return refused(bad_input("--program is for the simulated machine; LinuxCNC has its own",
                             "leave --program out"));
  }
  namespace adapter = adapters::linuxcnc;
  adapter::LinuxCncPort::Config config;
  config.units.axes = machine.axes.size();
  config.units.servo_period_s = machine.control.servo_period_s;
  for (std::size_t i = 0; i < std::min(machine.axes.size(), config.units.rotary.size()); ++i) {
    config.units.rotary[i] = machine.axes[i].rotary;
  }
  // One name for each process: that of a killed one is taken until LinuxCNC restarts.
  adapter::HalProcess::Config process;
  process.name = fmt::format("steadyrest-{}", ::getpid());
  process.axes = machine.axes.size();
  process.servo_period_s = machine.control.servo_period_s;
  auto hal = adapter::HalProcess::make(process);
  if (!hal) {
    return refused(hal.error());
  }
  auto port = adapter::LinuxCncPort::make(config, **hal);
  if (!port) {
    return refused(port.error());
  }
  LivePort out;
  out.period_s = machine.control.servo_period_s;
  out.paces = true;
  out.beside = std::shared_ptr<adapter::HalProcess>(std::move(*hal));
  out.port = std::move(*port);
  return out;
}
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
    return linuxcnc(machine, program);
  }
#endif
  return refused(bad_input(machine.file,
                           fmt::format("the port {} is not in this program; allowed: {}",
                                       passport::word(machine.port), kPorts),
                           "set port = \"sim\""));
}

}  // namespace steadyrest::apps::cli::live
