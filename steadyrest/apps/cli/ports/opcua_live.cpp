// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <chrono>
#include <cmath>
#include <cstdlib>
#include <filesystem>
#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <thread>
#include <utility>

#include <fmt/core.h>

#include <steadyrest/adapters/opcua/bridge_device.hpp>
#include <steadyrest/adapters/opcua/frame.hpp>
#include <steadyrest/adapters/opcua/node_check.hpp>
#include <steadyrest/adapters/opcua/opcua_port.hpp>
#include <steadyrest/adapters/opcua/program_name.hpp>
#include <steadyrest/apps/cli/ports/opcua_live.hpp>
#include <steadyrest/apps/cli/ports/program_place.hpp>
#include <steadyrest/apps/cli/shared/findings.hpp>
#include <steadyrest/kernel/outcome/bad_input.hpp>
#include <steadyrest/live/path/followed_port.hpp>
#include <steadyrest/live/path/program_watch.hpp>

namespace steadyrest::apps::cli::live {
namespace {

namespace adapter = adapters::opcua;
using adapter::BridgeClient;
using adapter::BridgeDevice;
using adapter::OpcUaPort;
using kernel::machine::Machine;
using kernel::signal::ProgramState;
using passport::Finding;
using passport::Severity;
using steadyrest::live::FollowedPort;
using steadyrest::live::LoadedProgram;
using steadyrest::live::ProgramWatch;

using Clock = std::chrono::steady_clock;
constexpr double kConnect_s = 20.0;
constexpr std::chrono::milliseconds kMoment(1000);
constexpr std::chrono::milliseconds kBetweenSamples(20);
constexpr int kSamples = 10;
constexpr double kDeadMen = 1.5;      ///< times of the dead man
constexpr double kClock = 10.0;       ///< faster or slower than this computer's, at most
constexpr double kClockDoubt = 1.25;  ///< likewise, without a word about it
constexpr double kWatch_s = 0.6;      ///< at least, to tell that
constexpr const char* kOpcUaCheck = "opcua";

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

/// What the control's side shows before this layer has sent anything.
struct Watched {
  double longest_s = 0.0;       ///< that a reading took
  bool other_layer = false;     ///< the control takes orders, or obeys somebody
  double clock = std::nan("");  ///< the control's by this computer's
  adapter::Reading last;
};

/// How long the reading took (s). A busy control may show no new sample, or not answer, for a
/// moment: it is asked again.
Result<double> read_patiently(BridgeDevice& device, adapter::Reading& reading) {
  const auto until = Clock::now() + kMoment;
  for (;;) {
    const auto starts = device.starts();
    const auto before = Clock::now();
    const auto read = device.read(reading);
    if (read && device.starts() == starts) {
      return std::chrono::duration<double>(Clock::now() - before).count();
    }
    if (read) {
      return 0.0;  // the bridge's start, not the control's time
    }
    if (Clock::now() > until) {
      return std::unexpected(read.error());
    }
    std::this_thread::sleep_for(kBetweenSamples);
  }
}

/// The control's side shows another sample each time.
Result<Watched> watch_samples(BridgeDevice& device, const kernel::machine::OpcUa& config) {
  using kernel::machine::Quantity;
  Watched out;
  adapter::Reading& reading = out.last;
  double heartbeat = std::nan("");
  double first_s = std::nan("");
  // A layer that has just ended is still obeyed for the dead man's time.
  const auto least =
      std::chrono::duration<double>(std::max(kDeadMen * config.dead_man_s, kWatch_s));
  auto begin = Clock::now();
  auto last = begin;
  for (int i = 0; i < kSamples || Clock::now() - begin < least; ++i) {
    const auto took_s = read_patiently(device, reading);
    if (!took_s) {
      return std::unexpected(took_s.error());
    }
    out.longest_s = std::max(out.longest_s, *took_s);
    last = Clock::now();
    if (i == 0) {
      begin = last;
      first_s = reading[Quantity::time_s];
    }
    const double seen = reading[Quantity::heartbeat_seen];
    if (std::isfinite(seen)) {
      out.other_layer = out.other_layer || (std::isfinite(heartbeat) && seen != heartbeat);
      heartbeat = seen;
    }
    std::this_thread::sleep_for(kBetweenSamples);
  }
  out.clock =
      (reading[Quantity::time_s] - first_s) / std::chrono::duration<double>(last - begin).count();
  out.other_layer = out.other_layer || reading[Quantity::layer_alive] > 0.0;
  return out;
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

/// Names may differ all the same: it is a warning. While the program runs the control may show the
/// name of a subprogram.
void check_program(const Machine& machine, const adapter::Reading& shown,
                   std::vector<Finding>& out) {
  const std::string_view name = shown.program.data();
  if (!machine.opcua.program.empty() &&
      adapter::program_state(shown, machine.opcua) == ProgramState::stopped && !name.empty() &&
      !adapter::same_program(name, machine.opcua.program)) {
    out.push_back({Severity::warning, kOpcUaCheck,
                   fmt::format("the control has selected {}, which is not the name of {}", name,
                               machine.opcua.program),
                   "select the program that the layer has, or give the file its name"});
  }
}

/// What the control shows, before this layer has sent anything.
void check_samples(const Machine& machine, BridgeDevice& device, std::vector<Finding>& out) {
  const auto watched = watch_samples(device, machine.opcua);
  if (!watched) {
    out.push_back(error_of(kOpcUaCheck, watched.error()));
    return;
  }
  if (watched->longest_s > machine.opcua.cycle_s) {
    out.push_back({Severity::warning, kOpcUaCheck,
                   fmt::format("the control takes up to {:.0f} ms for a reading, more than "
                               "cycle_ms = {:g}",
                               1e3 * watched->longest_s, 1e3 * machine.opcua.cycle_s),
                   "set cycle_ms above that, and dead_man_ms to at least three times as much"});
  }
  // A busy computer is late; a wrong unit is wrong by 60 and more.
  if (watched->clock < 1.0 / kClock || watched->clock > kClock) {
    out.push_back({Severity::error, kOpcUaCheck,
                   fmt::format("the control's clock goes {:.3g} times as fast as this computer's",
                               watched->clock),
                   "correct scale of time_s in the mapping: seconds"});
  } else if (watched->clock < 1.0 / kClockDoubt || watched->clock > kClockDoubt) {
    out.push_back(
        {Severity::warning, kOpcUaCheck,
         fmt::format("the control's clock runs {:.3g} times as fast as this computer's: every time "
                     "of its actions is wrong by that factor, the dead man's too",
                     watched->clock),
         "[control] interpolator_period_ms must be the control's MD10071, and the SPF that is "
         "loaded written with it; if both are right, one of the computers is too busy"});
  }
  for (const Refusal& fault : adapter::override_faults(watched->last, machine)) {
    out.push_back(error_of(kOpcUaCheck, fault));
  }
  for (const Refusal& fault : adapter::position_faults(watched->last, machine)) {
    out.push_back({Severity::warning, kOpcUaCheck, fault.what, fault.to_do});
  }
  if (const auto fault = adapter::motion_fault(watched->last, machine.opcua)) {
    out.push_back({Severity::warning, kOpcUaCheck, fault->what, fault->to_do});
  }
  check_program(machine, watched->last, out);
  if (watched->other_layer) {
    out.push_back(other_layer("another layer acts on this control",
                              "stop it: two layers would disturb each other"));
  }
}

/// The device is connected when there is no error among them.
std::vector<Finding> findings_by(BridgeDevice& device, const Machine& machine) {
  std::vector<Finding> out;
  if (machine.opcua.security == kernel::machine::OpcUaSecurity::none) {
    out.push_back({Severity::warning, kOpcUaCheck,
                   "security = \"none\": everybody in the network can read and change what is sent",
                   "use sign_and_encrypt, or a dedicated cable between the two computers"});
  }
  if (machine.opcua.writes.empty()) {
    out.push_back({Severity::note, kOpcUaCheck,
                   "the mapping writes nothing: the layer can only observe",
                   "add [[write]] to the mapping if it shall act"});
  }
  if (const auto connected = device.connect(kConnect_s); !connected) {
    out.push_back(error_of(kOpcUaCheck, connected.error()));
    return out;
  }
  const auto faults = device.check();
  if (!faults) {
    out.push_back(error_of(kOpcUaCheck, faults.error()));
    return out;
  }
  for (const Refusal& fault : *faults) {
    out.push_back(error_of(kOpcUaCheck, fault));
  }
  if (faults->empty()) {
    check_samples(machine, device, out);
  }
  return out;
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
  BridgeDevice device(opcua_client(machine));
  return findings_by(device, machine);
}

std::expected<LivePort, Refusals> open_opcua(const Machine& machine,
                                             const ProgramOptions& program) {
  ProgramOptions options = program;
  options.file = program.file.empty() ? machine.opcua.program : program.file;
  if (auto there = check_program_file(options.file); !there) {
    return std::unexpected(std::move(there.error()));
  }
  LivePort out;
  Machine with_program = machine;
  with_program.opcua.program = options.file;
  auto device = std::make_unique<BridgeDevice>(opcua_client(machine));
  out.findings = findings_by(*device, with_program);
  if (auto errors = errors_of(machine, out.findings); !errors.empty()) {
    return std::unexpected(std::move(errors));
  }
  auto* const bridge = device.get();
  auto made = OpcUaPort::make(machine, std::move(device));
  if (!made) {
    return refused(made.error());
  }
  std::shared_ptr<OpcUaPort> port = std::move(*made);
  out.period_s = layer_cycle_s(machine);
  out.holds_s = holds_s(machine);
  auto followed = std::make_unique<FollowedPort>(*port);
  std::shared_ptr<ProgramWatch> watch;
  if (!options.file.empty()) {
    auto start = program_config(options, machine);
    if (!start) {
      return refused(start.error());
    }
    start->on_control = true;
    watch = std::make_shared<ProgramWatch>(
        *followed, machine, shown({.file = options.file, .start = std::move(*start)}, *port), warn);
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
