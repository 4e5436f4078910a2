// SPDX-License-Identifier: Apache-2.0
#include <memory>

#include <steadyrest/apps/cli/program/ahead/inserted.hpp>
#include <steadyrest/apps/cli/program/verb_program_compensate.hpp>
#include <steadyrest/apps/cli/shared/rewrite_options.hpp>
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
  Answer answer;
  answer.text = put_insertions(answer, *done);
  return answer;
}

}  // namespace
}  // namespace program_compensate

void add_verb_program_compensate(Session& session, Verb& verb) {
  auto options = std::make_shared<program_compensate::Options>();
  add_machine_program_options(verb, options->rewrite.program);
  add_rewrite_options(verb, options->rewrite);
  add_changed_program(verb, options->output);
  verb.also_reads([options] { return files_of(options->rewrite); });
  session.on(verb,
             [options](Progress& progress) { return program_compensate::run(*options, progress); });
}

}  // namespace steadyrest::apps::cli
