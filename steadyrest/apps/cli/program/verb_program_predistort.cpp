// SPDX-License-Identifier: Apache-2.0
#include <memory>

#include <steadyrest/apps/cli/program/ahead/corrected_path.hpp>
#include <steadyrest/apps/cli/program/ahead/predicted_change.hpp>
#include <steadyrest/apps/cli/program/ahead/program_bounds.hpp>
#include <steadyrest/apps/cli/program/verb_program_predistort.hpp>
#include <steadyrest/apps/cli/shared/machine_option.hpp>
#include <steadyrest/kernel/file/output_file.hpp>

// What can be known beforehand belongs in the program: the path that the axes must be commanded so
// that the tool runs on the programmed one.
namespace steadyrest::apps::cli {
namespace program_predistort {
namespace {

struct Options {
  ProgramOptions program;
  std::string machine;
  PathOptions path;
  std::string output;
  const CLI::App* verb = nullptr;
};

Outcome run(Options options, Progress& progress) {
  progress.update(0.0, "reading the program");
  const auto program = read_source_program(options.program, options.machine);
  if (!program) {
    return std::unexpected(program.error());
  }
  if (const auto fits = within_bounds(*program, options.program.file, kLongestPath_s); !fits) {
    return refused(fits.error());
  }
  if (auto settled = settle_shift(options.path, *program); !settled) {
    return refused(settled.error());
  }
  auto told =
      told_of_change(changes_of(options.path), *options.verb, *program, told_of(options.path));
  if (!told) {
    return std::unexpected(told.error());
  }
  const auto done = corrected_path(options.path, *program, options.program.file, *told, progress);
  if (!done) {
    return refused(done.error());
  }
  if (auto written = kernel::file::write_file(options.output, done->done.replaced.text); !written) {
    return refused(written.error());
  }
  Answer answer;
  answer.text = put_corrected(answer, *done, options.path);
  put_replaced(answer, done->done.replaced);
  answer.text += put_kept(answer, program->blocks, Rewrites::path);
  return answer;
}

}  // namespace
}  // namespace program_predistort

void add_verb_program_predistort(Session& session, Verb& verb) {
  auto options = std::make_shared<program_predistort::Options>();
  options->verb = &verb;
  add_machine_program_options(verb, options->program);
  add_machine_option(verb, options->machine);
  add_path_options(verb, options->path);
  add_changed_program(verb, options->output);
  session.on(verb,
             [options](Progress& progress) { return program_predistort::run(*options, progress); });
}

}  // namespace steadyrest::apps::cli
