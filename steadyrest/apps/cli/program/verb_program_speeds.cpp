// SPDX-License-Identifier: Apache-2.0
#include <memory>

#include <fmt/core.h>

#include <steadyrest/apps/cli/program/ahead/changed_program.hpp>
#include <steadyrest/apps/cli/program/ahead/predicted_change.hpp>
#include <steadyrest/apps/cli/program/ahead/speeds_ahead.hpp>
#include <steadyrest/apps/cli/program/verb_program_speeds.hpp>
#include <steadyrest/apps/cli/shared/machine_option.hpp>
#include <steadyrest/kernel/file/output_file.hpp>
#include <steadyrest/nc/rewrite/tube/prove_made.hpp>

// For a control without a live connection: the speed that keeps a cut stable is known beforehand,
// so it can be written into the program.
namespace steadyrest::apps::cli {
namespace program_speeds {
namespace {

struct Options {
  ProgramOptions program;
  std::string machine;
  SpeedOptions speeds;
  std::string output;
  const CLI::App* verb = nullptr;
};

Outcome run(const Options& options, Progress& progress) {
  const std::string& file = options.program.file;
  const auto program = read_source_program(options.program, options.machine);
  if (!program) {
    return std::unexpected(program.error());
  }
  const auto done = speeds_ahead(options.speeds, *program, file, progress);
  if (!done) {
    return std::unexpected(done.error());
  }
  const auto told = told_of_change("speeds", *options.verb, *program,
                                   {{"depth-mm", fmt::format("{:g}", options.speeds.depth_mm)}});
  if (!told) {
    return std::unexpected(told.error());
  }
  const auto changed = nc::rewrite::replace(file, program->config.dialect, done->lines, *told);
  if (!changed) {
    return refused(changed.error());
  }
  if (const auto proof = nc::rewrite::prove_made(file, *changed, program->config, program->machine,
                                                 progress.reporter());
      !proof) {
    return refused(proof.error());
  }
  if (const auto written = kernel::file::write_file(options.output, changed->text); !written) {
    return refused(written.error());
  }
  Answer answer;
  answer.text = put_speeds(answer, *done);
  put_replaced(answer, *changed);
  put_unknown(answer, program->blocks.assumed);
  answer.text +=
      changed->replaced == 0
          ? std::string("the program is unchanged\n")
          : fmt::format("{} lines replaced; the feed per tooth is the same\n", changed->replaced);
  return answer;
}

}  // namespace
}  // namespace program_speeds

void add_verb_program_speeds(Session& session, Verb& verb) {
  auto options = std::make_shared<program_speeds::Options>();
  options->verb = &verb;
  add_machine_program_options(verb, options->program);
  add_machine_option(verb, options->machine);
  add_speed_options(verb, options->speeds);
  verb.get_option("--process")->required();
  verb.get_option("--depth-mm")->required();
  add_changed_program(verb, options->output);
  session.on(verb,
             [options](Progress& progress) { return program_speeds::run(*options, progress); });
}

}  // namespace steadyrest::apps::cli
