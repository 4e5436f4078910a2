// SPDX-License-Identifier: Apache-2.0
#include <optional>
#include <utility>

#include <fmt/core.h>

#include <steadyrest/apps/cli/cut/cut_plan.hpp>
#include <steadyrest/apps/cli/ports/lines_live.hpp>
#include <steadyrest/apps/cli/ports/linuxcnc_live.hpp>
#include <steadyrest/apps/cli/ports/live_port.hpp>
#include <steadyrest/apps/cli/ports/opcua_live.hpp>
#include <steadyrest/apps/cli/ports/repeating_port.hpp>
#include <steadyrest/nc/rewrite/original/original_path.hpp>
#include <steadyrest/passport/keys/schema.hpp>
#include <steadyrest/sim/simulated_machine.hpp>
#include <steadyrest/trial/cut/chatter_choice.hpp>
#include <steadyrest/trial/vibration/cut_simulation.hpp>

namespace steadyrest::apps::cli::live {
namespace {

/// The cut of the process along the program.
std::expected<std::optional<sim::CuttingVibration::Config>, Refusals> cutting_of(
    const kernel::machine::Machine& machine, const nc::plan::PlannedPath& path,
    const Simulated& simulated) {
  if (simulated.process == nullptr) {
    return std::nullopt;
  }
  const double slowest_rev_s = trial::cut::slowest_cut_rev_s(path);
  if (!(slowest_rev_s > 0.0)) {
    return refused(bad_input("the program cuts with the spindle stopped",
                             "program S and M3 before the first G1, or leave out --process"));
  }
  return sim::CuttingVibration::Config{
      .cut = trial::vibration::cutting_of(*simulated.process, simulated.depth_mm),
      .slowest_rev_s = slowest_rev_s *
                       trial::cut::least_spindle_ratio({}, simulated.layer_chooses_speed, machine)};
}

std::expected<LivePort, Refusals> simulated(const kernel::machine::Machine& machine,
                                            const ProgramOptions& program, const Simulated& of) {
  if (program.file.empty()) {
    return refused(bad_input("the simulated machine has nothing to cut", "give --program FILE"));
  }
  const auto planned = cut::plan(program, machine);
  if (!planned) {
    return std::unexpected(planned.error().refusals);
  }
  const auto cutting = cutting_of(machine, *planned->path, of);
  if (!cutting) {
    return std::unexpected(cutting.error());
  }
  const auto make = [config = sim::SimulatedMachine::Config{
                         .machine = machine, .path = planned->path, .cutting = *cutting}] {
    return sim::SimulatedMachine::make(config);
  };
  LivePort out;
  for (const std::string& words : nc::rewrite::words_of(*planned->path)) {
    out.findings.push_back({.severity = passport::Severity::warning,
                            .check = "text",
                            .what = program.file + ": " + words,
                            .to_do = "run the original for the layer's own correction"});
  }
  out.period_s = layer_cycle_s(machine);
  out.sensor = *cutting ? trial::listener::simulated_sensor() : trial::listener::Sensor();
  out.cutting_speeds_rev_s = trial::cut::cutting_speeds(*planned->path);
  if (of.repeats) {
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
constexpr bool kHasLinuxCnc = true;
constexpr const char* kPorts = "sim, linuxcnc, lines, opcua";
constexpr const char* kWithout = "set port = \"sim\"";
#else
constexpr bool kHasLinuxCnc = false;
constexpr const char* kPorts = "sim, lines, opcua";
constexpr const char* kWithout =
    "for linuxcnc install linuxcnc-uspace-dev and build again; otherwise set port = \"sim\"";
#endif

}  // namespace

Result<void> check_port(const kernel::machine::Machine& machine) {
  using enum kernel::machine::PortKind;
  if (machine.port == replay || (machine.port == linuxcnc && !kHasLinuxCnc)) {
    return std::unexpected(bad_input(machine.file,
                                     fmt::format("the port {} is not in this program; allowed: {}",
                                                 passport::word(machine.port), kPorts),
                                     kWithout));
  }
  return {};
}

std::expected<LivePort, Refusals> open_port(const kernel::machine::Machine& machine,
                                            const ProgramOptions& program, const Simulated& of) {
  if (const auto there = check_port(machine); !there) {
    return refused(there.error());
  }
  if (machine.port == kernel::machine::PortKind::sim) {
    return simulated(machine, program, of);
  }
  if (of.repeats) {
    return refused(bad_input("--repeat is for the simulated machine",
                             "leave it out; a control repeats its program itself"));
  }
  if (machine.port == kernel::machine::PortKind::lines) {
    return open_lines(machine, program);
  }
  if (machine.port == kernel::machine::PortKind::opcua) {
    return open_opcua(machine, program);
  }
#if STEADYREST_HAS_LINUXCNC
  return open_linuxcnc(machine, program);
#else
  return std::unexpected(Refusals());
#endif
}

}  // namespace steadyrest::apps::cli::live
