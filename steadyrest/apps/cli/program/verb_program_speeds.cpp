// SPDX-License-Identifier: Apache-2.0
#include <cmath>
#include <cstdint>
#include <memory>
#include <optional>

#include <fmt/core.h>

#include <steadyrest/apps/cli/program/changed_program.hpp>
#include <steadyrest/apps/cli/program/speeds_ahead.hpp>
#include <steadyrest/apps/cli/program/verb_program_speeds.hpp>
#include <steadyrest/apps/cli/shared/machine_option.hpp>
#include <steadyrest/apps/cli/shared/table.hpp>
#include <steadyrest/apps/cli/shared/value_check.hpp>
#include <steadyrest/chatter/offline/process/process_file.hpp>
#include <steadyrest/kernel/file/output_file.hpp>
#include <steadyrest/kernel/units/convert.hpp>
#include <steadyrest/nc/rewrite/replace/replace.hpp>
#include <steadyrest/nc/rewrite/replace/same_cut.hpp>

// For a control without a live connection: the speed that keeps a cut stable is known beforehand,
// so it can be written into the program.
namespace steadyrest::apps::cli {
namespace program_speeds {
namespace {

using kernel::units::rpm_from_rev_s;
using nc::rewrite::SpindleSpan;

struct Options {
  ProgramOptions program;
  std::string machine;
  std::string process;
  double depth_mm = 0.0;
  std::optional<std::int64_t> tool;
  std::string output;
  const CLI::App* verb = nullptr;
};

/// What was chosen, and the text that came of it.
struct Done {
  std::vector<SpindleSpan> spans;
  std::vector<SpeedChoice> choices;
  std::vector<double> ratio;
  nc::rewrite::Replaced changed;
};

Json or_null(const std::optional<double>& value) {
  return value && std::isfinite(*value) ? Json(*value) : Json(nullptr);
}

Answer answer_of(const Done& done) {
  Answer answer;
  Table table({"line", "tool", "cuts in", "rpm", "new rpm", "decision", "stable to mm"});
  std::string reasons;
  answer.json["cuts"] = Json::array();
  for (std::size_t i = 0; i < done.spans.size(); ++i) {
    const SpindleSpan& span = done.spans[i];
    const SpeedChoice& choice = done.choices[i];
    if (span.first_cut == 0) {
      continue;
    }
    const double rpm = rpm_from_rev_s(choice.speed_rev_s);
    const double ratio = done.ratio[i];
    const std::string& why = span.stays.empty() ? choice.why : span.stays;
    answer.json["cuts"].push_back(
        {{"line", span.speed.line},
         {"tool", span.tool},
         {"first_cut_line", span.first_cut},
         {"last_cut_line", span.last_cut},
         {"speed_rpm_before", span.surface_speed ? Json(nullptr) : Json(rpm)},
         {"speed_rpm_after", span.surface_speed ? Json(nullptr) : Json(rpm * ratio)},
         {"feed_ratio", ratio},
         {"decision", choice.decision},
         {"limit_depth_mm", or_null(choice.limit_depth_mm)},
         {"reason", why}});
    const auto depth = choice.limit_depth_mm;
    table.row({fmt::format("{}", span.speed.line), fmt::format("T{}", span.tool),
               fmt::format("{}–{}", span.first_cut, span.last_cut),
               span.surface_speed ? "G96" : fmt::format("{:.0f}", rpm),
               span.surface_speed ? "G96" : fmt::format("{:.0f}", rpm * ratio), choice.decision,
               !depth                  ? "–"
               : std::isfinite(*depth) ? fmt::format("{:.3f}", *depth)
                                       : "deeper than sought"});
    reasons += why.empty() ? "" : fmt::format("line {}: {}\n", span.speed.line, why);
  }
  answer.json["unchanged"] = done.changed.replaced == 0;
  answer.json["replaced_lines"] = done.changed.replaced;
  answer.text = table.text() + reasons +
                (done.changed.replaced == 0
                     ? std::string("the program is unchanged\n")
                     : fmt::format("{} lines replaced; the feed per tooth is the same\n",
                                   done.changed.replaced));
  return answer;
}

/// Asks the planner for each S word; a speed whose feed cannot be kept stays.
Result<void> choose(const Options& options, const SourceProgram& program,
                    const chatter::offline::Process& process, Progress& progress, Done& done) {
  auto spans = nc::rewrite::spindle_spans(options.program.file, program.config);
  if (!spans) {
    return std::unexpected(spans.error());
  }
  done.spans = std::move(*spans);
  auto choices = choose_speeds(
      {.process = process,
       .machine = program.machine,
       .depth_mm = options.depth_mm,
       .tool = options.tool,
       .progress = [&](double share, std::string_view what) { progress.update(share, what); }},
      done.spans);
  if (!choices) {
    return std::unexpected(choices.error());
  }
  done.choices = std::move(*choices);
  for (const SpeedChoice& choice : done.choices) {
    done.ratio.push_back(choice.ratio);
  }
  nc::rewrite::keep_carried_feeds(done.spans, done.ratio);
  for (std::size_t i = 0; i < done.ratio.size(); ++i) {
    if (done.ratio[i] != done.choices[i].ratio) {
      done.choices[i].decision = "stays";
      done.choices[i].limit_depth_mm.reset();
    }
  }
  return {};
}

/// Makes the text and proves it.
Result<void> change(const std::string& file, const SourceProgram& program,
                    const std::vector<nc::rewrite::Told>& told, Done& done) {
  const auto dialect = program.config.dialect;
  const auto lines = nc::rewrite::speed_lines(file, dialect, done.spans, done.ratio);
  if (!lines) {
    return std::unexpected(lines.error());
  }
  auto changed = nc::rewrite::replace(file, dialect, *lines, told);
  if (!changed) {
    return std::unexpected(changed.error());
  }
  done.changed = std::move(*changed);
  return nc::rewrite::prove_same_cut(file, done.changed, program.config,
                                     nc::rewrite::Changes::speeds, tolerance_mm(program));
}

Outcome run(const Options& options, Progress& progress) {
  const auto process = chatter::offline::read_process_all_faults(options.process);
  if (!process) {
    return std::unexpected(process.error());
  }
  const auto program = read_source_program(options.program, options.machine);
  if (!program) {
    return std::unexpected(program.error());
  }
  Done done;
  if (const auto chosen = choose(options, *program, *process, progress, done); !chosen) {
    return refused(chosen.error());
  }
  const auto told = told_of_change("speeds", *options.verb, *program,
                                   {{"depth-mm", fmt::format("{:g}", options.depth_mm)}});
  if (!told) {
    return std::unexpected(told.error());
  }
  if (const auto made = change(options.program.file, *program, *told, done); !made) {
    return refused(made.error());
  }
  if (const auto written = kernel::file::write_file(options.output, done.changed.text); !written) {
    return refused(written.error());
  }
  return answer_of(done);
}

}  // namespace
}  // namespace program_speeds

void add_verb_program_speeds(Session& session, Verb& verb) {
  auto options = std::make_shared<program_speeds::Options>();
  options->verb = &verb;
  add_machine_program_options(verb, options->program);
  add_machine_option(verb, options->machine);
  verb.reads("--process", options->process, "Process file (TOML) of the cuts")->required();
  verb.also_reads([options] { return chatter::offline::response_files(options->process); });
  verb.add_option("--depth-mm", options->depth_mm, "Depth of cut of that process")
      ->required()
      ->check(within(0.0001, 1000.0));
  verb.add_option("--tool", options->tool,
                  "Number of the tool that the process is for; cuts of others stay. Default: all");
  verb.writes("-o,--output", options->output,
              "The changed program; with --force it may replace the program itself",
              program_content())
      ->required();
  session.on(verb,
             [options](Progress& progress) { return program_speeds::run(*options, progress); });
}

}  // namespace steadyrest::apps::cli
