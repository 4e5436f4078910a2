// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <chrono>
#include <iterator>
#include <memory>
#include <optional>
#include <string>
#include <thread>
#include <utility>

#include <fmt/core.h>

#include <steadyrest/adapters/lines/lines_port.hpp>
#include <steadyrest/adapters/lines/other_client.hpp>
#include <steadyrest/apps/cli/ports/lines_live.hpp>
#include <steadyrest/apps/cli/ports/program_place.hpp>
#include <steadyrest/apps/cli/shared/findings.hpp>
#include <steadyrest/live/path/commanded_port.hpp>
#include <steadyrest/live/path/followed_port.hpp>
#include <steadyrest/live/path/program_watch.hpp>

namespace steadyrest::apps::cli::live {
namespace {

using adapters::lines::LinesPort;
using kernel::machine::Machine;
using kernel::machine::OverrideWires;
using kernel::signal::Frame;
using kernel::signal::OverrideState;
using passport::Finding;
using passport::Severity;
using steadyrest::live::CommandedPort;
using steadyrest::live::FollowedPort;
using steadyrest::live::LoadedProgram;
using steadyrest::live::ProgramWatch;

constexpr const char* kLinesCheck = "lines";
constexpr std::chrono::milliseconds kBetweenReadings(5);

/// Estimates of commanded positions are good to some hundredths of a millimetre at a turn.
constexpr double kNear_mm = 0.1;
constexpr double kFar_mm = 2.0;

/// Outlives the port that the loop has.
struct Beside {
  std::unique_ptr<LinesPort> port;
  std::unique_ptr<CommandedPort> commanded;
};

void check_panel(const char* name, const OverrideWires& wires, const OverrideState& state,
                 std::vector<Finding>& out) {
  if (!wires.out.empty() && !state.panel_code_known) {
    out.push_back({Severity::error, "panel",
                   fmt::format("the {} panel shows {:0{}b}, which is not in [override.{}]", name,
                               state.panel_code, wires.panel.size(), name),
                   "bits are swapped, inverted or stuck, or the table is another machine's: "
                   "steadyrest lines test --panel"});
  }
}

/// Before the port has the lines: a card gives them to one at a time.
std::vector<Finding> alone_findings(const Machine& machine) {
  auto wires = adapters::lines::open_wires(machine.lines);
  const auto pause = [] { std::this_thread::sleep_for(kBetweenReadings); };
  const auto other = wires ? adapters::lines::other_client(**wires, machine.lines, pause)
                           : std::unexpected(std::move(wires.error()));
  if (!other) {
    return {error_of(kLinesCheck, other.error())};
  }
  if (other->empty()) {
    return {};
  }
  return {other_layer(*other,
                      "stop it; if none runs, one has died and its module has no watchdog: switch "
                      "the module off and on")};
}

std::vector<Finding> panel_findings(const Machine& machine, const Result<Frame>& first) {
  if (!first) {
    return {error_of(kLinesCheck, first.error())};
  }
  std::vector<Finding> out;
  check_panel("feed", machine.lines.feed, first->feed, out);
  check_panel("spindle", machine.lines.spindle, first->spindle, out);
  return out;
}

/// The operator says which program the control has; its state shows on a line, if at all.
ProgramWatch::Source told(LoadedProgram program) {
  return [program = std::move(program),
          said = false](double wait_s) mutable -> Result<std::optional<LoadedProgram>> {
    if (std::exchange(said, true)) {
      std::this_thread::sleep_for(std::chrono::duration<double>(wait_s));
      return std::nullopt;
    }
    return program;
  };
}

Result<std::shared_ptr<ProgramWatch>> watch_of(const Machine& machine,
                                               const ProgramOptions& program,
                                               FollowedPort& followed) {
  if (program.file.empty()) {
    return nullptr;
  }
  auto start = program_config(program, machine);
  if (!start) {
    return std::unexpected(std::move(start.error()));
  }
  return std::make_shared<ProgramWatch>(
      followed, machine, told({.file = program.file, .start = std::move(*start)}), warn);
}

}  // namespace

std::vector<Finding> lines_findings(const Machine& machine) {
  auto out = alone_findings(machine);
  if (!out.empty() && out.front().severity == Severity::error) {
    return out;
  }
  if (!machine.lines.watchdog_registers.empty()) {
    out.push_back({Severity::note, kLinesCheck,
                   "nothing was written to the module: whether it keeps watchdog_registers is not "
                   "known",
                   "steadyrest lines test sets and reads them back"});
  }
  const auto port = LinesPort::open(machine, LinesPort::Use::looks);
  std::ranges::move(port ? panel_findings(machine, (*port)->read())
                         : std::vector<Finding>{error_of(kLinesCheck, port.error())},
                    std::back_inserter(out));
  return out;
}

std::expected<LivePort, Refusals> open_lines(const Machine& machine,
                                             const ProgramOptions& program) {
  const bool encoders = machine.recorder.fitted;
  if (!program.file.empty() && !encoders) {
    return refused(bad_input(machine.file, "a program is of no use without positions",
                             "add [recorder], or leave --program out"));
  }
  if (auto there = check_program_file(program.file); !there) {
    return std::unexpected(std::move(there.error()));
  }
  if (auto errors = errors_of(machine, alone_findings(machine)); !errors.empty()) {
    return std::unexpected(std::move(errors));
  }
  auto port = LinesPort::open(machine);
  if (!port) {
    return refused(port.error());
  }
  LivePort out;
  out.period_s = layer_cycle_s(machine);
  out.holds_s = holds_s(machine);
  if (auto errors = errors_of(machine, panel_findings(machine, (*port)->read())); !errors.empty()) {
    return std::unexpected(std::move(errors));
  }
  if (!encoders) {
    out.port = std::move(*port);
    return out;
  }
  auto beside = std::make_shared<Beside>();
  beside->port = std::move(*port);
  auto commanded = CommandedPort::make(*beside->port, machine);
  if (!commanded) {
    return refused(commanded.error());
  }
  beside->commanded = std::move(*commanded);
  auto followed = std::make_unique<FollowedPort>(
      *beside->commanded,
      FollowedPort::Config{
          .locator = {.near_mm = kNear_mm, .far_mm = kFar_mm, .without_lines = true},
          .estimated = true});
  auto watch = watch_of(machine, program, *followed);
  if (!watch) {
    return refused(watch.error());
  }
  if (*watch) {
    out.shows = [&path = *followed, &watched = **watch] {
      return Json{{"program", program_json(watched, path)}};
    };
  }
  out.beside = std::move(beside);
  out.port = std::move(followed);
  out.watch = std::move(*watch);
  return out;
}

}  // namespace steadyrest::apps::cli::live
