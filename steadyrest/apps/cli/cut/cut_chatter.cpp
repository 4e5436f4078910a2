// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <string>
#include <utility>

#include <fmt/format.h>

#include <steadyrest/apps/cli/cut/cut_chatter.hpp>
#include <steadyrest/apps/cli/shared/table.hpp>
#include <steadyrest/apps/page/cut/report.hpp>
#include <steadyrest/chatter/offline/process/process_file.hpp>
#include <steadyrest/kernel/units/convert.hpp>
#include <steadyrest/trial/listener/listener.hpp>
#include <steadyrest/trial/vibration/cut_simulation.hpp>

namespace steadyrest::apps::cli {
namespace {

namespace units = kernel::units;
using chatter::offline::PlanDecision;
using chatter::online::Law;
using kernel::machine::Machine;
using trial::cut::ChatterChoice;

constexpr const char* kPlan = "plan";
constexpr const char* kDetect = "detect";
constexpr const char* kMachine = "machine";

std::string choice_words(const ChatterChoice& choice) {
  const chatter::online::Modulation& m = choice.modulation;
  switch (choice.decision) {
    case PlanDecision::keep:
      return "the programmed speed is stable";
    case PlanDecision::constant:
      return fmt::format("override {:.4g} %", units::percent_from_ratio(m.mean_ratio));
    case PlanDecision::law:
      return fmt::format("{} ±{:.4g} % every {:.3g} s", chatter::online::name(m.law),
                         units::percent_from_ratio(m.amplitude_ratio), m.period_s);
    case PlanDecision::nothing:
      return "nothing helps";
  }
  return {};
}

/// The layer stays within the operator's switch (min(layer, panel)). A choice above 100 % therefore
/// works only if the operator opens the switch, and the answer says so.
std::string switch_words(const ChatterChoice& choice) {
  return choice.switch_ratio > 1.0
             ? fmt::format("; the operator's spindle switch is set to {:.4g} %",
                           units::percent_from_ratio(choice.switch_ratio))
             : "";
}

/// One choice, in per cent of the programmed speed.
Json json_of(const ChatterChoice& choice) {
  const chatter::online::Modulation& m = choice.modulation;
  const bool law = m.law != Law::constant;
  return {{"speed_rpm", units::rpm_from_rev_s(choice.speed_rev_s)},
          {"decision", chatter::offline::name(choice.decision)},
          {"mean_percent", units::percent_from_ratio(m.mean_ratio)},
          {"law", chatter::online::name(m.law)},
          {"rva", law ? m.amplitude_ratio : 0.0},
          {"period_s", law ? Json(m.period_s) : Json(nullptr)},
          {"spindle_switch_percent", units::percent_from_ratio(choice.switch_ratio)},
          {"notes", choice.notes}};
}

/// Only the difference between the two cuts counts, so each row has both. The wall is shown only if
/// both cuts have finished it.
std::string vibration_text(const trial::cut::VibrationFigures& without,
                           const trial::cut::VibrationFigures& with) {
  Table table({"the tool in the cut", "without the layer", "with the layer"});
  const auto row = [&](const char* name, const char* unit, double a, double b) {
    table.row({name, fmt::format("{:.3g} {}", a, unit), fmt::format("{:.3g} {}", b, unit)});
  };
  row("vibration, RMS", "µm", without.rms_um, with.rms_um);
  row("largest displacement", "µm", without.peak_um, with.peak_um);
  row("chatter (not tooth-periodic), RMS", "µm", without.unforced_rms_um, with.unforced_rms_um);
  row("largest force", "N", without.force_peak_n, with.force_peak_n);
  if (without.surface_range_um && with.surface_range_um) {
    row("finished wall, peak to valley", "µm", *without.surface_range_um, *with.surface_range_um);
  }
  return "\n" + table.text();
}

}  // namespace

CLI::Option* add_process_options(Verb& verb, ProcessOptions& options) {
  CLI::Option* process = verb.reads("--process", options.process,
                                    "Process file (TOML) for the cut in G1–G3, with its vibration");
  verb.also_reads([&options] { return chatter::offline::response_files(options.process); });
  verb.add_option("--depth-mm", options.depth_mm, "Depth of cut of that process")->needs(process);
  return process;
}

std::expected<double, Refusals> depth_of(const ProcessOptions& options) {
  if (!options.depth_mm || !(*options.depth_mm > 0.0)) {
    return refused(bad_input(options.depth_mm
                                 ? fmt::format("--depth-mm {} is not above 0", *options.depth_mm)
                                 : "--process without --depth-mm",
                             "give a depth of cut above 0, as in --depth-mm 1.5"));
  }
  return *options.depth_mm;
}

void add_cut_chatter_options(Verb& verb, CutChatterOptions& options) {
  CLI::Option* process = add_process_options(verb, options);
  verb.add_option("--chatter", options.source,
                  "How the layer fights chatter: plan (ask the planner for each spindle speed), "
                  "detect (hear it, then take a better step from the planner's table), machine "
                  "(use [chatter] of the machine file unchanged)")
      ->check(CLI::IsMember({kPlan, kDetect, kMachine}))
      ->capture_default_str()
      ->needs(process);
}

std::expected<CutChatter, Refusals> cut_chatter(const CutChatterOptions& options,
                                                const nc::plan::PlannedPath& path, Machine& machine,
                                                Progress& progress) {
  CutChatter out;
  // Without a process the cut has no forces, and everything below is left out.
  if (options.process.empty()) {
    return out;
  }
  if (const auto depth_mm = depth_of(options); !depth_mm) {
    return std::unexpected(depth_mm.error());
  }
  const auto process = chatter::offline::read_process_all_faults(options.process);
  if (!process) {
    return std::unexpected(process.error());
  }
  // A tooth that does not turn cuts nothing; the model divides by the speed.
  const double slowest = trial::cut::slowest_cut_rev_s(path);
  if (!(slowest > 0.0)) {
    return refused(bad_input("the program cuts with the spindle stopped",
                             "program S and M3 before the first G1, or leave out --process"));
  }
  if (options.source == kPlan) {
    auto choices = trial::cut::choose(
        *process, machine, trial::cut::cutting_speeds(path), *options.depth_mm,
        [&](double share, std::string_view what) { progress.update(share, what); });
    if (!choices) {
      return refused(choices.error());
    }
    out.choices = std::move(*choices);
    out.by_plan = true;
    out.warnings = trial::cut::unplanned_cuts(path);
    const bool acts = std::ranges::any_of(out.choices, [](const ChatterChoice& choice) {
      return choice.decision == PlanDecision::constant || choice.decision == PlanDecision::law;
    });
    // The file's own [chatter] would compete with the planner's choices for one override.
    machine.chatter.enabled = false;
    // The modulator waits at 100 % until the program reaches a speed with a choice. If no choice
    // acts, the machine gets no modulator at all.
    if (acts) {
      machine = trial::listener::with_modulator(std::move(machine));
    }
  }
  if (options.source == kDetect) {
    auto listener = trial::cut::listener_for(*process, machine, trial::cut::cutting_speeds(path),
                                             *options.depth_mm);
    if (!listener) {
      return refused(listener.error());
    }
    out.listener = std::move(*listener);
    machine = trial::listener::with_modulator(std::move(machine));
  }
  out.cutting = {.cut = trial::vibration::cutting_of(*process, *options.depth_mm),
                 // Made once, so the grid must be fine enough for whatever the layer may ask.
                 .slowest_rev_s = slowest * trial::cut::least_spindle_ratio(
                                                out.choices, out.listener.has_value(), machine)};
  return out;
}

/// Keys of both cuts, then what the layer heard, then what the planner chose.
void put_vibration(Answer& answer, const CutChatter& chatter, const trial::cut::Recorder& without,
                   const trial::cut::Recorder& with) {
  if (!chatter.cutting) {
    return;
  }
  const auto before = without.vibration() ? without.vibration()->figures() : std::nullopt;
  const auto after = with.vibration() ? with.vibration()->figures() : std::nullopt;
  if (before && after) {
    answer.json["without"].update(Json::parse(page::to_json(*before)));
    answer.json["with"].update(Json::parse(page::to_json(*after)));
    answer.text += vibration_text(*before, *after);
  }
  if (chatter.listener) {
    answer.json["heard"] = Json::array();
    for (const trial::cut::HeardChatter& heard : with.heard()) {
      answer.json["heard"].push_back(
          {{"time_s", heard.time_s},
           {"frequency_hz", heard.frequency_hz},
           {"spindle_percent", units::percent_from_ratio(heard.spindle_ratio)}});
      answer.text +=
          fmt::format("{:.3f} s: chatter at {:.0f} Hz; spindle override {:.4g} %\n", heard.time_s,
                      heard.frequency_hz, units::percent_from_ratio(heard.spindle_ratio));
    }
    answer.text += with.heard().empty() ? "no chatter heard, or no better step\n" : "";
  }
  if (!chatter.by_plan) {
    return;
  }
  answer.json["chatter"] = Json::array();
  // One choice for each spindle speed of the program.
  for (const ChatterChoice& choice : chatter.choices) {
    answer.json["chatter"].push_back(json_of(choice));
    answer.text += fmt::format("S{:.0f}: {}{}\n", units::rpm_from_rev_s(choice.speed_rev_s),
                               choice_words(choice), switch_words(choice));
  }
}

}  // namespace steadyrest::apps::cli
