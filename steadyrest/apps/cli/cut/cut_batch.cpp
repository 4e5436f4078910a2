// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <array>
#include <filesystem>
#include <string>
#include <utility>

#include <fmt/core.h>

#include <steadyrest/apps/cli/cut/cut_batch.hpp>
#include <steadyrest/apps/cli/shared/report_option.hpp>
#include <steadyrest/apps/cli/shared/rewrite_options.hpp>
#include <steadyrest/apps/cli/shared/table.hpp>
#include <steadyrest/apps/cli/shared/value_check.hpp>
#include <steadyrest/apps/page/thermal/thermal_page.hpp>
#include <steadyrest/kernel/units/convert.hpp>
#include <steadyrest/nc/interpret/program.hpp>
#include <steadyrest/nc/plan/time/program_timer.hpp>
#include <steadyrest/trial/batch/batch.hpp>

// `cut --batch`: a day of parts on a machine that warms up. The cut itself is followed by a batch
// in which the machine drifts by its thermal passport; the same parts are made without correction,
// with corrections in the program, and with the layer's on-line offset.
namespace steadyrest::apps::cli {
namespace {

using kernel::machine::Machine;
using kernel::units::um_from_mm;
using nc::rewrite::Method;
using trial::batch::Batch;
using trial::batch::Way;

/// Three ways to cut one batch: as it is, with corrections written into the text, and with the
/// layer on line.
constexpr std::array<std::pair<Way, const char*>, 3> kWays = {
    {{Way::without, "without"}, {Way::text, "text"}, {Way::online, "online"}}};

/// One part's cyclogram, from the same planner that the simulated control runs.
Result<std::vector<nc::plan::Transition>> cyclogram_of(const std::string& program,
                                                       const nc::interpret::Config& config,
                                                       const Machine& machine) {
  auto timer = nc::plan::ProgramTimer::make(machine);
  if (!timer) {
    return std::unexpected(timer.error());
  }
  const auto report = nc::interpret::run_file(program, config, *timer);
  if (!report) {
    return std::unexpected(report.error());
  }
  if (!report->refused.empty()) {
    return std::unexpected(nc::interpret::first_refusal(*report, program));
  }
  auto time = timer->take();
  if (!time) {
    return std::unexpected(time.error());
  }
  return std::move(time->cyclogram);
}

/// Sums for each way, then part by part. `worse_parts` counts parts that a correction made worse:
/// an improvement on average is no comfort to them.
Json json_of(const Batch& made) {
  Json out;
  out["axes"] = made.axis;
  out["band_um"] = um_from_mm(made.band_mm);
  out["program_s"] = made.program_s;
  out["total_s"] = made.total_s;
  for (const auto& [way, name] : kWays) {
    const trial::batch::Error& error = made.error[static_cast<std::size_t>(way)];
    out[name] = {{"largest_um", um_from_mm(error.largest_mm)},
                 {"rms_um", um_from_mm(error.rms_mm)}};
    if (way != Way::without) {
      out[name]["improvement"] = made.improvement(way);
      out[name]["worse_parts"] = made.worse(way);
    }
  }
  out["parts"] = Json::array();
  for (const trial::batch::Part& part : made.part) {
    Json one = {{"start_s", part.start_s}, {"corrections", part.corrections}};
    for (const auto& [way, name] : kWays) {
      const trial::batch::Error& error = part.error[static_cast<std::size_t>(way)];
      one[name] = {{"largest_um", um_from_mm(error.largest_mm)},
                   {"rms_um", um_from_mm(error.rms_mm)}};
    }
    out["parts"].push_back(std::move(one));
  }
  return out;
}

/// error[0 … 2] in the order of Way: without, text, online.
std::string text_of(const Batch& made) {
  const auto um = [](double mm) { return fmt::format("{:.1f}", um_from_mm(mm)); };
  // The largest error of each part, because the worst spot of a part decides whether it passes.
  Table table({"part", "start min", "without um", "in program um", "on line um", "corrections"});
  for (std::size_t i = 0; i < made.part.size(); ++i) {
    const trial::batch::Part& part = made.part[i];
    table.row({fmt::format("{}", i + 1), fmt::format("{:.0f}", part.start_s / 60.0),
               um(part.error[0].largest_mm), um(part.error[1].largest_mm),
               um(part.error[2].largest_mm), fmt::format("{}", part.corrections)});
  }
  table.row({"all", "", um(made.error[0].largest_mm), um(made.error[1].largest_mm),
             um(made.error[2].largest_mm), ""});
  return fmt::format(
      "\nthermal drift over {} parts, largest error\n{}corrected in the program {:.1f} times "
      "smaller, on line {:.1f} times\n",
      made.part.size(), table.text(), made.improvement(Way::text), made.improvement(Way::online));
}

}  // namespace

std::string batch_folder(const std::string& report) {
  return (std::filesystem::path(report) / "batch").string();
}

/// Pauses and breaks matter: it is the cooling between parts and over lunch that a simple warm-up
/// model gets wrong.
void add_cut_batch_options(Verb& verb, CutBatchOptions& options) {
  auto* parts =
      verb.add_option("--batch", options.parts,
                      "Also cut a batch of this many parts from cold, by the thermal passport: "
                      "uncorrected, corrected in the program, and corrected on line")
          ->check(within(1, 10000));
  verb.add_option("--pause-min", options.pause_min, "Pause after each part of the batch")
      ->check(within(0.0, 1440.0))
      ->needs(parts);
  auto* break_min = verb.add_option("--break-min", options.break_min,
                                    "An extra, longer pause after every --break-after parts")
                        ->check(within(0.0, 10000.0))
                        ->needs(parts);
  break_min->needs(
      verb.add_option("--break-after", options.break_after, "Parts between two of these pauses")
          ->check(within(1, 10000))
          ->needs(parts));
  verb.add_option("--tolerance-um", options.tolerance_um,
                  "Tolerance of the parts; drift may take the machine's share k of it")
      ->check(within(0.01, 1e5))
      ->needs(parts);
}

/// Cuts the batch and adds it to the answer of `cut`. The corrections go into the program in the
/// way that the machine file names for its control.
Result<void> put_batch(Answer& answer, const CutBatchOptions& options,
                       const ProgramOptions& program, const Machine& machine,
                       const std::string& directory, Progress& progress) {
  if (options.parts == 0) {
    return {};
  }
  auto config = program_config(program, machine);
  if (!config) {
    return std::unexpected(config.error());
  }
  const auto way = way_of({}, machine, config->dialect);
  if (!way) {
    return std::unexpected(way.error().front());
  }
  // On a Haas G10 L2 P0 is G52 and no external offset; the interpreter must read it as such.
  config->external_offset = way->method != Method::haas;
  auto cyclogram = cyclogram_of(program.file, *config, machine);
  if (!cyclogram) {
    return std::unexpected(cyclogram.error());
  }
  trial::batch::Job job;
  job.machine = machine;
  job.program = program.file;
  job.config = std::move(*config);
  job.cyclogram = std::move(*cyclogram);
  static_cast<nc::rewrite::Way&>(job.settings) = *way;
  // The same clamp as on line, so that the two ways compete under equal limits.
  job.settings.clamp_mm = machine.envelope.max_offset_mm;
  job.parts = options.parts;
  job.pause_s = 60.0 * options.pause_min;
  job.break_s = 60.0 * options.break_min;
  job.break_after = options.break_after;
  job.tolerance_mm = kernel::units::mm_from_um(options.tolerance_um);
  job.progress = [&progress](double share) { progress.update(share, "cutting the batch"); };
  const auto made = trial::batch::run(job);
  if (!made) {
    return std::unexpected(made.error());
  }
  progress.clear();
  answer.json["batch"] = json_of(*made);
  answer.text += text_of(*made);
  if (directory.empty()) {
    return {};
  }
  const std::string folder = batch_folder(directory);
  page::Json page = page::batch_page(answer.json["batch"], program.file, *made);
  answer.json["batch"]["report"] = add_report(answer, folder, std::move(page));
  return {};
}

}  // namespace steadyrest::apps::cli
