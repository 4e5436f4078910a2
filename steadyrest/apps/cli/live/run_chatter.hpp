// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <expected>
#include <optional>
#include <string>

#include <steadyrest/apps/cli/cut/cut_chatter.hpp>
#include <steadyrest/apps/cli/ports/live_port.hpp>
#include <steadyrest/apps/cli/shared/progress.hpp>
#include <steadyrest/apps/cli/shared/session.hpp>
#include <steadyrest/apps/live_page/desk.hpp>
#include <steadyrest/chatter/offline/process/process.hpp>
#include <steadyrest/kernel/machine/machine.hpp>
#include <steadyrest/trial/listener/listener.hpp>

/// The chatter part of `steadyrest run`: what is cut, and what the layer does when it chatters.
namespace steadyrest::apps::cli::live {

struct RunChatterOptions : ProcessOptions {
  std::string choice = "detect";  ///< or machine
};

void add_run_chatter_options(Verb& verb, RunChatterOptions& options);

struct RunProcess {
  std::string file;
  std::string text;
  chatter::offline::Process process;
  double depth_mm = 0.0;
  bool acts = true;  ///< takes a better spindle speed when it chatters; else the layer only hears
};

/// None without --process. Refused: a process without depth, a process file with faults.
[[nodiscard]] std::expected<std::optional<RunProcess>, Refusals> read_run_process(
    const RunChatterOptions& options);

/// Why the layer cannot act against chatter on this machine; nothing: it can, or need not.
[[nodiscard]] std::optional<Refusal> unfit(const std::optional<RunProcess>& process,
                                           const kernel::machine::Machine& machine);

[[nodiscard]] Simulated simulated_of(const std::optional<RunProcess>& process, bool repeats);

/// The layer's ear, and the machine as a layer with it has it. Takes as long as the planner does.
/// Refused: a port without a vibration sensor, and what the planner refuses.
[[nodiscard]] Result<std::optional<trial::listener::Listener>> listener_of(
    const std::optional<RunProcess>& process, kernel::machine::Machine& machine,
    const LivePort& port, Progress& progress);

/// Empty where there is none.
[[nodiscard]] std::string listener_text(const std::optional<trial::listener::Listener>& listener);

/// For the page.
[[nodiscard]] std::optional<live_page::ChatterDesk> chatter_desk(
    const std::optional<RunProcess>& process);

}  // namespace steadyrest::apps::cli::live
