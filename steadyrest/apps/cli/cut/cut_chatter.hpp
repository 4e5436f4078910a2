// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <string>
#include <vector>

#include <CLI/CLI.hpp>

#include <steadyrest/apps/cli/shared/progress.hpp>
#include <steadyrest/apps/cli/shared/session.hpp>
#include <steadyrest/kernel/machine/machine.hpp>
#include <steadyrest/nc/plan/check/machine_check.hpp>
#include <steadyrest/nc/plan/path/planned_path.hpp>
#include <steadyrest/sim/cut/cutting_vibration.hpp>
#include <steadyrest/trial/cut/chatter_choice.hpp>
#include <steadyrest/trial/cut/recorder.hpp>

/// The chatter part of `steadyrest cut`: what is cut, and what the layer does about chatter.
namespace steadyrest::apps::cli {

/// What is cut.
struct ProcessOptions {
  std::string process;
  std::optional<double> depth_mm;
};

/// `--process` and `--depth-mm`; returns the first.
CLI::Option* add_process_options(Verb& verb, ProcessOptions& options);
/// Refused: a process without a depth above 0.
[[nodiscard]] std::expected<double, Refusals> depth_of(const ProcessOptions& options);

struct CutChatterOptions : ProcessOptions {
  std::string source = "plan";  ///< of the layer's choice: plan, detect, machine
};

void add_cut_chatter_options(Verb& verb, CutChatterOptions& options);

/// What both cuts need.
struct CutChatter {
  std::optional<sim::CuttingVibration::Config> cutting;  ///< empty: no process was given
  std::vector<trial::cut::ChatterChoice> choices;
  std::optional<supervisor::ListeningStage> listener;
  bool by_plan = false;
  std::vector<nc::plan::Warning> warnings;  ///< cuts not covered by the plan
};

/// Reads the process, asks the planner for the program's spindle speeds, and switches the machine's
/// modulator on where the plan decides.
[[nodiscard]] std::expected<CutChatter, Refusals> cut_chatter(const CutChatterOptions& options,
                                                              const nc::plan::PlannedPath& path,
                                                              kernel::machine::Machine& machine,
                                                              Progress& progress);

/// `vibration` of both cuts, as keys next to their figures, and `chatter`: what was chosen.
void put_vibration(Answer& answer, const CutChatter& chatter, const trial::cut::Recorder& without,
                   const trial::cut::Recorder& with);

}  // namespace steadyrest::apps::cli
