// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <map>
#include <memory>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include <fmt/core.h>

#include <steadyrest/apps/cli/cut/cut_batch.hpp>
#include <steadyrest/apps/cli/cut/cut_chatter.hpp>
#include <steadyrest/apps/cli/cut/verb_cut.hpp>
#include <steadyrest/apps/cli/shared/machine_option.hpp>
#include <steadyrest/apps/cli/shared/program_options.hpp>
#include <steadyrest/apps/cli/shared/program_warnings.hpp>
#include <steadyrest/apps/cli/shared/report_option.hpp>
#include <steadyrest/apps/cli/shared/table.hpp>
#include <steadyrest/apps/page/cut/report.hpp>
#include <steadyrest/kernel/outcome/reason.hpp>
#include <steadyrest/kernel/units/convert.hpp>
#include <steadyrest/nc/plan/check/idle_override.hpp>
#include <steadyrest/nc/plan/path/path_builder.hpp>
#include <steadyrest/trial/cut/comparison.hpp>
#include <steadyrest/trial/cut/cut_job.hpp>

namespace steadyrest::apps::cli {
// The main job. One path is planned once, cut twice on the same simulated machine with the same
// noise, and only the layer differs; so every difference in the figures comes from the layer.
namespace cut {
namespace {

using kernel::machine::ContourStrategy;
using kernel::machine::Machine;
using kernel::outcome::Kind;
using kernel::outcome::Reason;
using nc::plan::PlannedPath;
using trial::cut::Figures;
using trial::cut::Recorder;
using PathPointer = std::shared_ptr<const PlannedPath>;

struct Options {
  ProgramOptions program;
  std::string machine;
  std::string believed;  ///< machine file for the layer alone; empty: the machine's own
  std::string report;
  std::optional<double> limit_um;
  std::optional<std::string> strategy;
  CutChatterOptions chatter;
  CutBatchOptions batch;
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

/// The program as the machine's control plans it, with warnings about what the machine cannot do.
struct Planned {
  PathPointer path;
  std::vector<nc::plan::Warning> warnings;
  std::size_t warning_count = 0;
};

/// One pass through the program feeds the planner and the check. A refused block ends the job: a
/// part with a block left out is not the part.
std::expected<Planned, Answer> plan(const ProgramOptions& options, const Machine& machine) {
  Answer answer;
  const auto config = program_config(options, machine);
  if (!config) {
    answer.refusals.push_back(config.error());
    answer.exit_code = kRefused;
    return std::unexpected(std::move(answer));
  }
  nc::plan::PathBuilder builder(machine);
  nc::plan::MachineCheck check(machine, known_in_simulation());
  nc::plan::Both both(builder, check);
  const auto report = nc::interpret::run_file(options.file, *config, both);
  if (!report) {
    answer.refusals.push_back(report.error());
    // A missing file is the user's mistake; a disk that fails while it is read is not.
    answer.exit_code = report.error().kind == Kind::bad_input ? kRefused : kFailed;
    return std::unexpected(std::move(answer));
  }
  if (!report->refused.empty()) {
    put_report(answer, *report, options.file);
    say_dialect(answer, options, machine);
    return std::unexpected(std::move(answer));
  }
  auto path = builder.take();
  if (!path) {
    Refusal refusal = path.error();
    refusal.file = options.file;
    answer.refusals.push_back(std::move(refusal));
    answer.exit_code = kRefused;
    return std::unexpected(std::move(answer));
  }
  if (path->segments.empty()) {
    answer.refusals.push_back(bad_input(options.file, "the program moves no axis",
                                        "give a program with at least one motion"));
    answer.exit_code = kRefused;
    return std::unexpected(std::move(answer));
  }
  Planned out{std::make_shared<const PlannedPath>(std::move(*path)), check.warnings(),
              check.count()};
  // If the feed override hardly acts because the axes never reach the programmed feed, the layer
  // has little to work with; that warning comes first.
  if (auto idle = nc::plan::idle_override(*out.path, machine.feed_override)) {
    out.warnings.insert(out.warnings.begin(), std::move(*idle));
    ++out.warning_count;
  }
  return out;
}

/// Keys that scripts rely on; see the list in the command line's documentation.
Json json_of(const Figures& figures) {
  return {{"cycle_time_s", figures.cycle_time_s},
          {"contour_error_max_mm", figures.contour_error_max_mm},
          {"contour_error_rms_mm", figures.contour_error_rms_mm},
          {"tracking_error_max_mm", figures.tracking_error_max_mm},
          {"over_limit_s", figures.over_limit_s},
          {"override_changes", figures.override_changes},
          {"cutting_time_s", figures.cutting_time_s},
          {"samples", figures.samples},
          {"samples_over_limit", figures.samples_over_limit}};
}

/// Coverage is the share of samples whose true value lies within the stated bound: 1, or a
/// guarantee was broken.
Json json_of(const std::vector<trial::cut::MotionFigures>& motion) {
  Json axes = Json::array();
  for (const trial::cut::MotionFigures& m : motion) {
    axes.push_back(page::to_object(m));
  }
  return axes;
}

/// Innovation: reading less forecast. A reading outside the band is not believed, and `reason` says
/// so.
Json json_of(const std::vector<trial::cut::ProbeFigures>& probes) {
  Json out = Json::array();
  for (const trial::cut::ProbeFigures& p : probes) {
    out.push_back({{"time_s", p.time_s},
                   {"line", p.line},
                   {"axis", p.axis},
                   {"displacement_um", p.displacement_um},
                   {"innovation_um", p.innovation_um},
                   {"band_um", p.band_um},
                   {"reason", kernel::outcome::name(p.reason)}});
  }
  return out;
}

/// The two cuts side by side: what the layer gained in error and what it cost in time.
std::string text_of(const Figures& without, const Figures& with, double limit_mm) {
  using kernel::units::um_from_mm;
  const auto um = [](double mm) { return fmt::format("{:.1f} µm", um_from_mm(mm)); };
  const auto seconds = [](double s) { return fmt::format("{:.2f} s", s); };
  return Table({"", "without the layer", "with the layer"})
      .row({"cycle time", seconds(without.cycle_time_s), seconds(with.cycle_time_s)})
      .row({"contour error, largest", um(without.contour_error_max_mm),
            um(with.contour_error_max_mm)})
      .row({"contour error, RMS", um(without.contour_error_rms_mm), um(with.contour_error_rms_mm)})
      .row({"tracking error, largest", um(without.tracking_error_max_mm),
            um(with.tracking_error_max_mm)})
      .row({fmt::format("over the limit of {}", um(limit_mm)), seconds(without.over_limit_s),
            seconds(with.over_limit_s)})
      .row({"override changes", fmt::format("{}", without.override_changes),
            fmt::format("{}", with.override_changes)})
      .text();
}

/// How good the estimates of each axis's motion were in the cut with the layer, against the
/// differences of counts that a control without time stamps would use.
std::string text_of(const std::vector<trial::cut::MotionFigures>& motion, const Machine& machine) {
  if (motion.empty()) {
    return {};
  }
  Table table({"motion estimate error, RMS", "estimate", "by differencing counts"});
  for (const trial::cut::MotionFigures& m : motion) {
    // Inside, a rotary axis is in rad; people read degrees.
    const bool rotary = std::ranges::any_of(
        machine.axes, [&](const auto& axis) { return axis.rotary && axis.name == m.axis; });
    const auto both = [rotary](double velocity, double acceleration) {
      using kernel::units::deg_from_rad;
      return rotary ? fmt::format("{:.3g} °/s, {:.3g} °/s²", deg_from_rad(velocity),
                                  deg_from_rad(acceleration))
                    : fmt::format("{:.3g} mm/s, {:.3g} mm/s²", velocity, acceleration);
    };
    table.row({m.axis, both(m.velocity_rms_mm_s, m.acceleration_rms_mm_s2),
               both(m.difference_velocity_rms_mm_s, m.difference_acceleration_rms_mm_s2)});
  }
  return "\n" + table.text();
}

/// What became of the probe's readings: found, how much of it the model had not forecast, and the
/// band within which a reading is believed.
std::string text_of(const std::vector<trial::cut::ProbeFigures>& probes) {
  if (probes.empty()) {
    return {};
  }
  Table table({"probe", "line", "finds", "not forecast", "accepted within", ""});
  for (const trial::cut::ProbeFigures& p : probes) {
    table.row({fmt::format("{} at {:.1f} s", p.axis, p.time_s), fmt::format("{}", p.line),
               fmt::format("{:.2f} µm", p.displacement_um),
               fmt::format("{:.2f} µm", p.innovation_um), fmt::format("±{:.2f} µm", p.band_um),
               std::string{kernel::outcome::name(p.reason)}});
  }
  return "\n" + table.text();
}

/// Why and how long the layer withdrew because of its input. Withdrawing outside of cuts is normal
/// and not reported.
std::string put_withdrawn(Answer& answer, const Recorder& with) {
  answer.json["withdrawn"] = Json::array();
  std::string text;
  for (const Reason reason :
       {Reason::input_not_finite, Reason::input_out_of_range, Reason::input_stale}) {
    const auto found = with.time_by_reason().find(reason);
    if (found == with.time_by_reason().end()) {
      continue;
    }
    answer.json["withdrawn"].push_back(
        {{"reason", kernel::outcome::name(reason)}, {"seconds", found->second}});
    text += fmt::format("the layer withdrew for {:.1f} s: {}: {}\n", found->second,
                        kernel::outcome::name(reason), kernel::outcome::sentence(reason));
  }
  return text.empty() ? text : "\n" + text;
}

/// One run of the simulated machine over the whole path.
Result<Recorder> cut_once(const Machine& machine, const std::optional<Machine>& believed,
                          const PathPointer& path, const CutChatter& chatter, bool with_layer,
                          Progress& progress) {
  // Each cut takes about half of the time.
  const double from = with_layer ? 0.5 : 0.0;
  const char* what = with_layer ? "cutting with the layer" : "cutting without the layer";
  return trial::cut::run(
      {.machine = machine,
       .path = path,
       .with_layer = with_layer,
       .believed = believed,
       .cutting = chatter.cutting,
       .choices = chatter.choices,
       .listener = chatter.listener,
       .progress = [&](double share) { progress.update(from + share / 2, what); }});
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

Outcome run(const Options& options, Progress& progress) {
  auto machine = machine_from(options.machine, options);
  const auto believed = believed_machine(options);
  if (!machine || !believed) {
    return std::unexpected(machine ? believed.error() : machine.error());
  }
  auto planned = plan(options.program, *machine);
  if (!planned) {
    return std::move(planned.error());
  }
  const PathPointer& path = planned->path;
  // This may switch the machine's modulator on, so it comes before both cuts.
  const auto chatter = cut_chatter(options.chatter, *path, *machine, progress);
  if (!chatter) {
    return std::unexpected(chatter.error());
  }
  planned->warnings.insert(planned->warnings.begin(), chatter->warnings.begin(),
                           chatter->warnings.end());
  planned->warning_count += chatter->warnings.size();
  const auto without = cut_once(*machine, *believed, path, *chatter, false, progress);
  if (!without) {
    return refused(without.error());
  }
  const auto with = cut_once(*machine, *believed, path, *chatter, true, progress);
  if (!with) {
    return refused(with.error());
  }
  // The batch draws its own bar.
  progress.clear();
  Answer answer;
  answer.json["program"] = options.program.file;
  answer.json["machine"] = machine->name;
  answer.json["limit_um"] = kernel::units::um_from_mm(machine->contour.limit_mm);
  answer.json["without"] = json_of(without->figures());
  answer.json["with"] = json_of(with->figures());
  answer.json["motion"] = json_of(with->motion());
  answer.json["probes"] = json_of(with->probes());
  answer.text = text_of(without->figures(), with->figures(), machine->contour.limit_mm) +
                text_of(with->motion(), *machine) + text_of(with->probes()) +
                put_withdrawn(answer, *with) +
                put_warnings(answer, planned->warnings, planned->warning_count);
  put_vibration(answer, *chatter, *without, *with);
  if (auto done =
          put_batch(answer, options.batch, options.program, *machine, options.report, progress);
      !done) {
    return refused(done.error());
  }
  if (!options.report.empty()) {
    page::Json page =
        page::to_page(trial::cut::compare(options.program.file, *machine, *without, *with));
    // The page shows the warnings too; they are not part of the comparison.
    page["warnings"] = answer.json["warnings"];
    page["warning_count"] = answer.json["warning_count"];
    put_report(answer, options.report, std::move(page));
  }
  return answer;
}

}  // namespace
}  // namespace cut

void add_verb_cut(Session& session, Verb& verb) {
  auto options = std::make_shared<cut::Options>();
  add_machine_program_options(verb, options->program);
  add_machine_option(verb, options->machine);
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
