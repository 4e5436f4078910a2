// SPDX-License-Identifier: Apache-2.0
#include <memory>

#include <fmt/core.h>

#include <steadyrest/apps/cli/program/verb_program_compensate.hpp>
#include <steadyrest/apps/cli/shared/rewrite_options.hpp>
#include <steadyrest/apps/cli/shared/table.hpp>
#include <steadyrest/nc/rewrite/correct/compensate.hpp>

// A plan of corrections becomes text in the program. Each correction goes to a safe place within a
// window around its planned time; where there is none, the program is refused and not half
// corrected.
namespace steadyrest::apps::cli {
namespace program_compensate {
namespace {

struct Options {
  RewriteOptions rewrite;
  std::string output;
};

/// One row for each place where the text changed: which line, when it is reached, what it adds.
Answer answer_of(const nc::rewrite::Compensated& done) {
  Answer answer;
  Table table({"line", "axis", "time s", "planned s", "shift um", "total um", "place"});
  answer.json["insertions"] = Json::array();
  for (const auto& one : done.insertions) {
    answer.json["insertions"].push_back({{"line", one.line},
                                         {"original_line", one.original_line},
                                         {"axis", std::string(1, one.axis)},
                                         {"time_s", one.time_s},
                                         {"planned_s", one.planned_s},
                                         {"delta_um", one.delta_um},
                                         {"total_um", one.total_um},
                                         {"place", nc::rewrite::name(one.site)}});
    table.row({fmt::format("{}", one.line), std::string(1, one.axis),
               fmt::format("{:.1f}", one.time_s), fmt::format("{:.1f}", one.planned_s),
               fmt::format("{:.2f}", one.delta_um), fmt::format("{:.2f}", one.total_um),
               std::string(nc::rewrite::name(one.site))});
  }
  answer.json["inserted_lines"] = done.inserted_lines;
  answer.json["seconds"] = done.program_s;
  answer.json["proved_moves"] = done.proof.moves;
  answer.text = done.insertions.empty() ? "the plan corrects nothing\n" : table.text();
  return answer;
}

/// compensate() proves its result before it writes: the changed program is interpreted again and
/// compared move by move.
Outcome run(const Options& options, Progress& progress) {
  const auto task = read_rewrite_task(options.rewrite, progress);
  if (!task) {
    return std::unexpected(task.error());
  }
  const auto done =
      nc::rewrite::compensate(options.rewrite.program.file, options.output, task->plan,
                              task->config, task->machine, task->settings);
  if (!done) {
    return refused(done.error());
  }
  return answer_of(*done);
}

}  // namespace
}  // namespace program_compensate

void add_verb_program_compensate(Session& session, Verb& verb) {
  auto options = std::make_shared<program_compensate::Options>();
  add_machine_program_options(verb, options->rewrite.program);
  add_rewrite_options(verb, options->rewrite);
  verb.writes("-o,--output", options->output,
              "The changed program; with --force it may replace the program itself",
              program_content())
      ->required();
  verb.also_reads([options] { return files_of(options->rewrite); });
  session.on(verb,
             [options](Progress& progress) { return program_compensate::run(*options, progress); });
}

}  // namespace steadyrest::apps::cli
