// SPDX-License-Identifier: Apache-2.0
#include <filesystem>
#include <map>
#include <memory>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include <fmt/core.h>

#include <steadyrest/apps/cli/cut/cut_against.hpp>
#include <steadyrest/apps/cli/cut/cut_answer.hpp>
#include <steadyrest/apps/cli/cut/cut_batch.hpp>
#include <steadyrest/apps/cli/cut/cut_best.hpp>
#include <steadyrest/apps/cli/cut/cut_chatter.hpp>
#include <steadyrest/apps/cli/cut/cut_every.hpp>
#include <steadyrest/apps/cli/cut/cut_plan.hpp>
#include <steadyrest/apps/cli/cut/cut_runs.hpp>
#include <steadyrest/apps/cli/cut/cut_ways.hpp>
#include <steadyrest/apps/cli/cut/part_recorder.hpp>
#include <steadyrest/apps/cli/cut/verb_cut.hpp>
#include <steadyrest/apps/cli/shared/machine_option.hpp>
#include <steadyrest/apps/cli/shared/program_options.hpp>
#include <steadyrest/apps/cli/shared/program_warnings.hpp>
#include <steadyrest/apps/cli/shared/report_option.hpp>
#include <steadyrest/apps/page/cut/report.hpp>
#include <steadyrest/kernel/units/convert.hpp>
#include <steadyrest/trial/cut/comparison.hpp>

namespace steadyrest::apps::cli {
// The main job. One path is planned once, cut twice on the same simulated machine with the same
// noise, and only the layer differs; so every difference in the figures comes from the layer. A
// changed program is judged by its original's path, and the original is cut too.
namespace cut {
namespace {

using kernel::machine::ContourStrategy;
using kernel::machine::Machine;
using kernel::outcome::Result;
using trial::cut::Recorder;

struct Options {
  ProgramOptions program;
  std::string machine;
  std::string believed;  ///< machine file for the layer alone; empty: the machine's own
  std::string report;
  std::string record;
  std::optional<double> limit_um;
  std::optional<std::string> strategy;
  AgainstOptions against;
  WaysOptions ways;
  CutChatterOptions chatter;
  CutBatchOptions batch;
  const CLI::App* verb = nullptr;

  /// The plain question: what is the best that this part can be?
  [[nodiscard]] bool asks_best() const {
    return !ways.quick && against.file.empty() && believed.empty() && record.empty() &&
           chatter.process.empty() && batch.parts == 0;
  }
};

const std::map<std::string, ContourStrategy> kStrategies = {
    {"contour_priority", ContourStrategy::contour_priority},
    {"feed_priority", ContourStrategy::feed_priority},
    {"combined", ContourStrategy::combined}};

/// Options of the command line take precedence over the machine file.
std::optional<Refusal> apply(const Options& options, Machine& machine) {
  if (options.limit_um) {
    if (!(*options.limit_um >= 0.1 && *options.limit_um <= 10'000.0)) {
      return bad_input(fmt::format("--limit-um {} is outside 0.1 … 10000", *options.limit_um),
                       "give the largest contour error the part may have");
    }
    machine.contour.limit_mm = kernel::units::mm_from_um(*options.limit_um);
  }
  if (options.strategy) {
    machine.contour.strategy = kStrategies.at(*options.strategy);
  }
  return std::nullopt;
}

/// A machine file with the command line's options.
std::expected<Machine, Refusals> machine_from(const std::string& file, const Options& options) {
  auto machine = read_machine(file);
  if (machine) {
    if (auto fault = apply(options, *machine)) {
      return std::unexpected(Refusals{std::move(*fault)});
    }
  }
  return machine;
}

/// What the layer is told of the machine; nothing where that is the machine's own file.
std::expected<std::optional<Machine>, Refusals> believed_machine(const Options& options) {
  if (options.believed.empty()) {
    return std::nullopt;
  }
  auto machine = machine_from(options.believed, options);
  if (!machine) {
    return std::unexpected(machine.error());
  }
  return std::move(*machine);
}

/// The cuts of one command.
struct Cuts {
  std::optional<Recorder> original;  ///< without the layer; only with --against
  Recorder without;
  Recorder with;
  Ways ways;  ///< empty where they are not compared
  std::optional<EveryWay> every;
};

/// The cuts that are made anyway are ways too.
void add_ways(Cuts& cuts, const Setup& setup) {
  using trial::cut::Way;
  const bool offsets = permits_offsets(setup);
  auto& ways = cuts.ways.ways;
  if (cuts.original) {
    ways.push_back({Way::alone, cuts.original->figures()});
    ways.push_back({Way::changed, cuts.without.figures()});
    ways.push_back(
        {offsets ? Way::changed_path_offsets : Way::changed_feed_override, cuts.with.figures()});
  } else {
    ways.push_back({Way::alone, cuts.without.figures()});
    ways.push_back({offsets ? Way::path_offsets : Way::feed_override, cuts.with.figures(),
                    offsets ? "the layer, by path offsets" : "the layer, by feed override"});
  }
  cuts.ways.sort();
}

/// Compared by themselves for a plain program, and in a report where there are several.
bool wants_ways(const Options& options, const Setup& setup, bool changed) {
  const bool worth = changed || permits_offsets(setup);
  return options.asks_best() || options.ways.ways || options.ways.curve ||
         (!options.report.empty() && worth);
}

/// The cut without the layer, recorded where that is wanted.
Result<Recorder> cut_without(const Options& options, Asked asked, CutRuns& runs) {
  if (options.record.empty()) {
    return runs.run(asked);
  }
  auto record = PartRecorder::open(options.record);
  if (!record) {
    return std::unexpected(record.error());
  }
  asked.on_frame = [&](const kernel::signal::Frame& frame) { record->add(frame); };
  auto cut = runs.run(asked);
  if (cut) {
    if (auto written = record->commit(); !written) {
      return std::unexpected(written.error());
    }
  }
  return cut;
}

Result<Cuts> cut_all(const Setup& setup, const PathPointer& path,
                     const std::shared_ptr<const trial::cut::Original>& against,
                     const Options& options, Progress& progress) {
  std::vector<Further> further;
  if (wants_ways(options, setup, against != nullptr)) {
    further =
        further_runs(setup, against ? against->as_cut : path, against != nullptr, options.ways);
  }
  const bool best = options.asks_best() && !against;
  CutRuns runs(setup, progress, (against ? 3 : 2) + further.size() + (best ? kMostEvery : 0));
  std::optional<Recorder> original;
  if (against) {
    auto cut = runs.run({.what = "cutting the original", .path = against->as_cut});
    if (!cut) {
      return std::unexpected(cut.error());
    }
    original = std::move(*cut);
  }
  auto without = cut_without(
      options, {.what = "cutting without the layer", .path = path, .against = against}, runs);
  if (!without) {
    return std::unexpected(without.error());
  }
  auto with = runs.run(
      {.what = "cutting with the layer", .path = path, .with_layer = true, .against = against});
  if (!with) {
    return std::unexpected(with.error());
  }
  Cuts cuts{std::move(original), std::move(*without), std::move(*with), {}, {}};
  for (const Further& one : further) {
    const auto cut = runs.run(one.asked);
    if (!cut) {
      return std::unexpected(cut.error());
    }
    if (one.curve_limit_um > 0.0) {
      cuts.ways.curve.push_back({one.curve_limit_um, cut->figures()});
    } else {
      cuts.ways.ways.push_back({one.way, cut->figures(), one.get});
    }
  }
  if (wants_ways(options, setup, against != nullptr)) {
    add_ways(cuts, setup);
  }
  if (best && (options.ways.all || !is_long(*path, cuts.without.figures()))) {
    auto every = cut_every(setup,
                           {.program = options.program,
                            .machine_file = options.machine,
                            .machine = setup.machine,
                            .verb = *options.verb},
                           path, cuts.with, runs, cuts.ways.ways, progress);
    if (!every) {
      return std::unexpected(every.error());
    }
    cuts.every = std::move(*every);
    cuts.ways.sort();
  }
  return cuts;
}

/// The figures of all cuts, as JSON and as text.
void put_cuts(Answer& answer, const Cuts& cuts, const Machine& machine) {
  std::vector<Column> columns;
  const auto put = [&](const char* key, const std::string& head, const Recorder& cut) {
    answer.json[key] = json_of(cut.figures());
    columns.push_back({head, cut.figures()});
  };
  if (cuts.original) {
    put("original", "original", *cuts.original);
  }
  put("without", cuts.original ? "changed, without" : "without the layer", cuts.without);
  put("with", cuts.original ? "changed, with" : "with the layer", cuts.with);
  answer.json["motion"] = json_of(cuts.with.motion());
  answer.json["probes"] = json_of(cuts.with.probes());
  const double limit_mm = machine.contour.limit_mm;
  if (cuts.every) {
    answer.text += put_best(answer, cuts.every->best, cuts.without.figures(), limit_mm);
  }
  answer.text += text_of(columns, limit_mm) + put_ways(answer, cuts.ways, limit_mm);
  if (cuts.every) {
    answer.text += put_over(answer, cuts.every->over_limit);
    answer.json["not_possible"] = cuts.every->not_possible;
    for (const std::string& why : cuts.every->not_possible) {
      answer.notes += "not possible: " + why + "\n";
    }
  }
  answer.text += text_of(cuts.with.motion(), machine) + text_of(cuts.with.probes()) +
                 put_withdrawn(answer, cuts.with);
}

/// The report: the comparison, and what belongs to the whole command.
void put_page(Answer& answer, const Options& options, const Machine& machine, const Cuts& cuts) {
  trial::cut::ReportData data =
      trial::cut::compare(options.program.file, machine, cuts.without, cuts.with);
  data.against = options.against.file.empty() && cuts.original
                     ? std::string(cut::kByMarks)
                     : std::filesystem::path(options.against.file).filename().string();
  data.ways = cuts.ways.ways;
  data.curve = cuts.ways.curve;
  if (cuts.every) {
    data.best = cuts.every->best;
    data.best_run = cuts.every->best_run;
    data.over_limit = cuts.every->over_limit;
  }
  page::Json page = page::to_page(data);
  // The page shows the warnings too; they are not part of the comparison.
  page["warnings"] = answer.json["warnings"];
  page["warning_count"] = answer.json["warning_count"];
  put_report(answer, options.report, std::move(page));
}

Outcome run(const Options& options, Progress& progress) {
  auto machine = machine_from(options.machine, options);
  auto believed = believed_machine(options);
  if (!machine || !believed) {
    return std::unexpected(machine ? believed.error() : machine.error());
  }
  auto planned = plan(options.program, *machine);
  if (!planned) {
    return std::move(planned.error());
  }
  const auto against = read_original(options.against, options.program, planned->path, *machine);
  if (!against) {
    return against.error();
  }
  if (!*against && !planned->path->original_unknown.empty()) {
    planned->warnings.insert(planned->warnings.begin(),
                             {.line = 1,
                              .text = "the errors here are against the path of the text, which is "
                                      "not the part's; --against names the original"});
    ++planned->warning_count;
  }
  // This may switch the machine's modulator on, so it comes before all cuts.
  auto chatter = cut_chatter(options.chatter, *planned->path, *machine, progress);
  if (!chatter) {
    return std::unexpected(chatter.error());
  }
  planned->warnings.insert(planned->warnings.begin(), chatter->warnings.begin(),
                           chatter->warnings.end());
  planned->warning_count += chatter->warnings.size();
  const Setup setup{std::move(*machine), std::move(*believed), std::move(*chatter)};
  const auto cuts = cut_all(setup, planned->path, *against, options, progress);
  if (!cuts) {
    return refused(cuts.error());
  }
  // The batch draws its own bar.
  progress.clear();
  Answer answer;
  answer.json["program"] = options.program.file;
  answer.json["machine"] = setup.machine.name;
  answer.json["limit_um"] = kernel::units::um_from_mm(setup.machine.contour.limit_mm);
  if (*against) {
    answer.text += put_against(answer, options.against, **against);
  }
  put_cuts(answer, *cuts, setup.machine);
  answer.text += put_assumed(answer, planned->report);
  answer.text += put_warnings(answer, planned->warnings, planned->warning_count);
  put_unknown(answer, planned->report.unknown);
  put_opaque(answer, planned->report);
  put_vibration(answer, setup.chatter, cuts->without, cuts->with);
  if (auto done = put_batch(answer, options.batch, options.program, setup.machine, options.report,
                            progress);
      !done) {
    return refused(done.error());
  }
  if (!options.report.empty()) {
    put_page(answer, options, setup.machine, *cuts);
  }
  return answer;
}

}  // namespace
}  // namespace cut

void add_verb_cut(Session& session, Verb& verb) {
  auto options = std::make_shared<cut::Options>();
  options->verb = &verb;
  add_machine_program_options(verb, options->program);
  add_machine_option(verb, options->machine);
  cut::add_against_options(verb, options->against);
  cut::add_ways_options(verb, options->ways);
  verb.reports(options->report, [options](const std::string& folder) {
    std::vector<PlannedFile> files = report_files(folder);
    // A batch has its own report in a folder below, which must be declared before the work.
    if (options->batch.parts > 0) {
      for (PlannedFile& file : report_files(batch_folder(folder))) {
        files.push_back(std::move(file));
      }
    }
    return files;
  });
  cut::add_record_option(verb, options->record);
  verb.add_option("--layer-machine", options->believed,
                  "Machine file that the layer is given instead: shows what a wrong one costs")
      ->type_name("FILE");
  verb.add_option("--limit-um", options->limit_um,
                  "Contour error limit, overriding the machine file");
  verb.add_option("--strategy", options->strategy, "Strategy, overriding the machine file")
      ->check(CLI::IsMember(cut::kStrategies));
  add_cut_chatter_options(verb, options->chatter);
  add_cut_batch_options(verb, options->batch);
  session.on(verb, [options](Progress& progress) { return cut::run(*options, progress); });
}

}  // namespace steadyrest::apps::cli
