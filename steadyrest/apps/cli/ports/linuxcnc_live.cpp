// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <cstddef>
#include <memory>
#include <utility>

#include <steadyrest/adapters/linuxcnc/hal_process.hpp>
#include <steadyrest/adapters/linuxcnc/linuxcnc_port.hpp>
#include <steadyrest/apps/cli/ports/linuxcnc_control.hpp>
#include <steadyrest/apps/cli/ports/linuxcnc_live.hpp>
#include <steadyrest/apps/cli/ports/program_place.hpp>
#include <steadyrest/live/path/followed_port.hpp>

// Beside the port runs a process that reads LinuxCNC's status, and a thread that plans the program
// it has loaded.
namespace steadyrest::apps::cli::live {
namespace {

namespace adapter = adapters::linuxcnc;
using steadyrest::live::FollowedPort;
using steadyrest::live::ProgramWatch;

/// Outlives the port that the loop has.
struct Beside {
  std::unique_ptr<adapter::HalProcess> hal;
  std::unique_ptr<adapter::LinuxCncPort> port;
};

Json stalls_json(const adapter::LinuxCncPort& port) {
  return {{"lost", port.missed()}, {"passed_over", port.skipped()}, {"rearmed", port.rearmed()}};
}

Result<std::shared_ptr<Beside>> connect(const kernel::machine::Machine& machine) {
  auto beside = std::make_shared<Beside>();
  adapter::HalProcess::Config process;
  process.axes = machine.axes.size();
  process.servo_period_s = machine.control.servo_period_s;
  process.hold_s = holds_s(machine);
  // Feed per tooth must not rise on the way back.
  process.rise_1_s = std::min(machine.envelope.feed_rise_1_s, machine.envelope.spindle_slew_1_s);
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
  ControlSource source(machine);
  auto compared = compare_with_control(source, machine);
  if (!compared) {
    return std::unexpected(std::move(compared.error()));
  }
  auto beside = connect(machine);
  if (!beside) {
    Refusal why = std::move(beside.error());
    if (!compared->shown) {
      why.what = "LinuxCNC does not run, or runs as another user (" + why.what + ")";
      why.to_do = "start LinuxCNC with the layer's HAL file, as this user";
    }
    return refused(why);
  }
  auto followed = std::make_unique<FollowedPort>(*(*beside)->port);
  auto watch = std::make_shared<ProgramWatch>(*followed, machine, std::move(source), warn);
  LivePort out;
  out.period_s = machine.control.servo_period_s;
  out.paces = true;
  out.holds_s = holds_s(machine);
  out.sensor.rate_hz = (*beside)->hal->vibration_rate_hz();
  out.findings = std::move(compared->findings);
  out.accepts = [machine, control = std::move(compared->file)](const auto& wanted) {
    return accepts(machine, control, wanted);
  };
  out.shows = [&port = *(*beside)->port, &path = *followed, &told = *watch] {
    return Json{{"program", program_json(told, path)}, {"stalls", stalls_json(port)}};
  };
  out.beside = std::move(*beside);
  out.port = std::move(followed);
  out.watch = std::move(watch);
  return out;
}

}  // namespace steadyrest::apps::cli::live
