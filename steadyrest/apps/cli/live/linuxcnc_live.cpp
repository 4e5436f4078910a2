// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <array>
#include <chrono>
#include <cstddef>
#include <memory>
#include <optional>
#include <string_view>
#include <thread>
#include <utility>

#include <steadyrest/adapters/linuxcnc/control_peer.hpp>
#include <steadyrest/adapters/linuxcnc/hal_process.hpp>
#include <steadyrest/adapters/linuxcnc/linuxcnc_port.hpp>
#include <steadyrest/apps/cli/live/linuxcnc_live.hpp>
#include <steadyrest/live/followed_port.hpp>

// Beside the port runs a process that reads LinuxCNC's status, and a thread that plans the program
// it has loaded.
namespace steadyrest::apps::cli::live {
namespace {

namespace adapter = adapters::linuxcnc;
using steadyrest::live::FollowedPort;
using steadyrest::live::LoadedProgram;
using steadyrest::live::ProgramWatch;

/// Outlives the port that the loop has.
struct Beside {
  std::unique_ptr<adapter::HalProcess> hal;
  std::unique_ptr<adapter::LinuxCncPort> port;
};

/// The control's state; a process that has ended is started again.
class ControlSource {
 public:
  explicit ControlSource(kernel::machine::Machine machine) : machine_(std::move(machine)) {}

  Result<std::optional<LoadedProgram>> operator()(double wait_s) {
    if (!peer_) {
      auto started = adapter::ControlPeer::start({});
      if (!started) {
        return failed(std::move(started.error()), wait_s);
      }
      peer_ = std::move(*started);
    }
    auto state = peer_->next(wait_s);
    if (!state) {
      peer_.reset();
      return failed(std::move(state.error()), wait_s);
    }
    if (!*state) {
      return std::optional<LoadedProgram>();
    }
    auto loaded = loaded_program(**state, machine_);
    if (!loaded) {
      return std::unexpected(std::move(loaded.error()));
    }
    return std::optional(std::move(*loaded));
  }

 private:
  static std::unexpected<Refusal> failed(Refusal refusal, double wait_s) {
    std::this_thread::sleep_for(std::chrono::duration<double>(wait_s));
    return std::unexpected(std::move(refusal));
  }

  kernel::machine::Machine machine_;
  std::shared_ptr<adapter::ControlPeer> peer_;
};

Json program_json(const ProgramWatch& watch, const FollowedPort& port) {
  constexpr std::array<std::string_view, 5> kPlaces = {"no_route", "no_program", "searching",
                                                       "off_path", "on_path"};
  const ProgramWatch::Status status = watch.status();
  return {{"file", status.file},
          {"segments", status.segments},
          {"place", kPlaces[static_cast<std::size_t>(port.place())]},
          {"words", status.words.empty() ? Json(nullptr) : Json(status.words)}};
}

Result<std::shared_ptr<Beside>> connect(const kernel::machine::Machine& machine) {
  auto beside = std::make_shared<Beside>();
  adapter::HalProcess::Config process;
  process.axes = machine.axes.size();
  process.servo_period_s = machine.control.servo_period_s;
  auto hal = adapter::HalProcess::make(process);
  if (!hal) {
    return std::unexpected(std::move(hal.error()));
  }
  adapter::LinuxCncPort::Config config;
  config.units.axes = machine.axes.size();
  config.units.linear_unit_mm = (*hal)->linear_unit_mm();
  config.units.servo_period_s = machine.control.servo_period_s;
  config.offset_slew_mm_s = machine.envelope.offset_slew_mm_s;
  for (std::size_t i = 0; i < std::min(machine.axes.size(), config.units.rotary.size()); ++i) {
    config.units.rotary[i] = machine.axes[i].rotary;
  }
  auto port = adapter::LinuxCncPort::make(config, **hal);
  if (!port) {
    return std::unexpected(std::move(port.error()));
  }
  beside->hal = std::move(*hal);
  beside->port = std::move(*port);
  return beside;
}

}  // namespace

std::expected<LivePort, Refusals> open_linuxcnc(const kernel::machine::Machine& machine,
                                                const ProgramOptions& program) {
  if (!program.file.empty()) {
    return refused(bad_input("--program is for the simulated machine; LinuxCNC has its own",
                             "leave --program out"));
  }
  auto beside = connect(machine);
  if (!beside) {
    return refused(beside.error());
  }
  auto followed = std::make_unique<FollowedPort>(*(*beside)->port);
  auto watch = std::make_shared<ProgramWatch>(*followed, machine, ControlSource(machine));
  LivePort out;
  out.period_s = machine.control.servo_period_s;
  out.paces = true;
  out.program = [&port = *followed, &told = *watch] { return program_json(told, port); };
  out.beside = std::move(*beside);
  out.port = std::move(followed);
  out.watch = std::move(watch);
  return out;
}

}  // namespace steadyrest::apps::cli::live
