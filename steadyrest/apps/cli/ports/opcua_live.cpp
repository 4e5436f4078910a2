// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <chrono>
#include <cstdlib>
#include <filesystem>
#include <memory>
#include <optional>
#include <string>
#include <thread>
#include <utility>

#include <fmt/core.h>

#include <steadyrest/adapters/opcua/bridge_device.hpp>
#include <steadyrest/adapters/opcua/node_check.hpp>
#include <steadyrest/adapters/opcua/opcua_port.hpp>
#include <steadyrest/apps/cli/ports/opcua_live.hpp>
#include <steadyrest/apps/cli/ports/program_place.hpp>
#include <steadyrest/live/path/followed_port.hpp>
#include <steadyrest/live/path/program_watch.hpp>

namespace steadyrest::apps::cli::live {
namespace {

namespace adapter = adapters::opcua;
using adapter::BridgeClient;
using adapter::BridgeDevice;
using adapter::OpcUaPort;
using kernel::machine::Machine;
using passport::Finding;
using passport::Severity;
using steadyrest::live::FollowedPort;
using steadyrest::live::LoadedProgram;
using steadyrest::live::ProgramWatch;

constexpr double kConnect_s = 20.0;
constexpr std::chrono::milliseconds kBetweenSamples(20);
constexpr int kSamples = 10;
constexpr const char* kCheck = "opcua";

std::string beside_program() {
  std::error_code error;
  const auto self = std::filesystem::read_symlink("/proc/self/exe", error);
  return (self.parent_path().parent_path() / "libexec" / "steadyrest" / "opcua-bridge.cjs")
      .string();
}

std::string state_folder() {
  const char* const state = std::getenv("XDG_STATE_HOME");
  const char* const home = std::getenv("HOME");
  const std::filesystem::path base =
      state != nullptr && *state != '\0'
          ? std::filesystem::path(state)
          : std::filesystem::path(home != nullptr ? home : "/var/lib") / ".local" / "state";
  return (base / "steadyrest" / "opcua").string();
}

/// The control's side shows another sample each time. The longest that a reading takes, s.
Result<double> check_sample(BridgeDevice& device) {
  using Clock = std::chrono::steady_clock;
  adapter::Reading reading;
  if (auto connected = device.connect(kConnect_s); !connected) {
    return std::unexpected(std::move(connected.error()));
  }
  std::chrono::duration<double> longest{};
  for (int i = 0; i < kSamples; ++i) {
    const auto before = Clock::now();
    if (auto read = device.read(reading); !read) {
      return std::unexpected(std::move(read.error()));
    }
    longest = std::max<std::chrono::duration<double>>(longest, Clock::now() - before);
    std::this_thread::sleep_for(kBetweenSamples);
  }
  return longest.count();
}

/// Of the control's program what the operator names; its state is the control's own.
ProgramWatch::Source shown(LoadedProgram program, OpcUaPort& port) {
  return [program = std::move(program), &port, seen = std::optional<bool>()](
             double wait_s) mutable -> Result<std::optional<LoadedProgram>> {
    const auto state = port.program().state;
    const bool stopped = state == kernel::signal::ProgramState::stopped;
    if (seen == stopped) {
      std::this_thread::sleep_for(std::chrono::duration<double>(wait_s));
      return std::nullopt;
    }
    seen = stopped;
    program.stopped = stopped;
    return program;
  };
}

}  // namespace

BridgeClient::Config opcua_client(const Machine& machine) {
  const char* const named = std::getenv("STEADYREST_OPCUA_BRIDGE");
  return {.process = {.script = named != nullptr && *named != '\0' ? named : beside_program()},
          .machine = machine.opcua,
          .state_folder =
              machine.opcua.certificates.empty() ? state_folder() : machine.opcua.certificates};
}

std::vector<Finding> opcua_findings(const Machine& machine) {
  std::vector<Finding> out;
  if (machine.opcua.security == kernel::machine::OpcUaSecurity::none) {
    out.push_back({Severity::warning, kCheck,
                   "security = \"none\": everybody in the network can read and change what is sent",
                   "use sign_and_encrypt, or a dedicated cable between the two computers"});
  }
  if (machine.opcua.writes.empty()) {
    out.push_back({Severity::note, kCheck, "the mapping writes nothing: the layer can only observe",
                   "add [[write]] to the mapping if it shall act"});
  }
  const adapter::NodePlan plan(machine.opcua);
  {
    BridgeClient client(opcua_client(machine), plan);
    const auto connected = client.connect(kConnect_s);
    if (!connected) {
      out.push_back({Severity::error, kCheck, connected.error().what, connected.error().to_do});
      return out;
    }
    const auto checked = client.check();
    if (!checked) {
      out.push_back({Severity::error, kCheck, checked.error().what, checked.error().to_do});
      return out;
    }
    for (const Refusal& fault : adapter::node_faults(*checked, plan, machine.opcua)) {
      out.push_back({Severity::error, kCheck, fault.what, fault.to_do});
    }
  }
  if (std::ranges::none_of(out,
                           [](const Finding& one) { return one.severity == Severity::error; })) {
    BridgeDevice device(opcua_client(machine));
    if (const auto shown = check_sample(device); !shown) {
      out.push_back({Severity::error, kCheck, shown.error().what, shown.error().to_do});
    } else if (*shown > machine.opcua.cycle_s) {
      out.push_back({Severity::warning, kCheck,
                     fmt::format("the control takes up to {:.0f} ms for a reading, more than "
                                 "cycle_ms = {:g}",
                                 1e3 * *shown, 1e3 * machine.opcua.cycle_s),
                     "set cycle_ms above that, and dead_man_ms to three times as much"});
    }
  }
  return out;
}

std::expected<LivePort, Refusals> open_opcua(const Machine& machine,
                                             const ProgramOptions& program) {
  ProgramOptions options = program;
  options.file = program.file.empty() ? machine.opcua.program : program.file;
  if (auto there = check_program_file(options.file); !there) {
    return std::unexpected(std::move(there.error()));
  }
  LivePort out;
  Refusals refusals;
  for (Finding& finding : opcua_findings(machine)) {
    if (finding.severity == Severity::error) {
      refusals.push_back(bad_input(machine.file, finding.what, finding.to_do));
    } else {
      out.findings.push_back(std::move(finding));
    }
  }
  if (!refusals.empty()) {
    return std::unexpected(std::move(refusals));
  }
  auto device = std::make_unique<BridgeDevice>(opcua_client(machine));
  if (const auto connected = device->connect(kConnect_s); !connected) {
    return refused(connected.error());
  }
  auto* const bridge = device.get();
  auto made = OpcUaPort::make(machine, std::move(device));
  if (!made) {
    return refused(made.error());
  }
  std::shared_ptr<OpcUaPort> port = std::move(*made);
  out.period_s = layer_cycle_s(machine);
  auto followed = std::make_unique<FollowedPort>(*port);
  std::shared_ptr<ProgramWatch> watch;
  if (!options.file.empty()) {
    auto start = program_config(options, machine);
    if (!start) {
      return refused(start.error());
    }
    start->on_control = true;
    watch = std::make_shared<ProgramWatch>(
        *followed, machine, shown({.file = options.file, .start = std::move(*start)}, *port));
  }
  out.shows = [port, bridge, &path = *followed, watch] {
    const auto alive = port->in_force();
    Json json = {{"opcua",
                  {{"in_force", alive ? Json(*alive) : Json(nullptr)},
                   {"bridge_starts", bridge->starts()}}}};
    if (watch) {
      json["program"] = program_json(*watch, path);
    }
    return json;
  };
  out.beside = port;
  out.port = std::move(followed);
  out.watch = std::move(watch);
  return out;
}

}  // namespace steadyrest::apps::cli::live
