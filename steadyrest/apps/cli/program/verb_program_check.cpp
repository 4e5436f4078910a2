// SPDX-License-Identifier: Apache-2.0
#include <memory>
#include <optional>

#include <fmt/core.h>

#include <steadyrest/apps/cli/program/verb_program_check.hpp>
#include <steadyrest/apps/cli/shared/machine_option.hpp>
#include <steadyrest/apps/cli/shared/program_options.hpp>
#include <steadyrest/apps/cli/shared/program_warnings.hpp>
#include <steadyrest/apps/cli/shared/table.hpp>

namespace steadyrest::apps::cli {
namespace program_check {
namespace {

/// Nothing is ignored: a word that is not understood is listed with its line and the reason.
std::string text_of(const nc::interpret::Report& report) {
  if (report.refused.empty()) {
    return fmt::format("accepted: {} blocks, {} moves\n", report.blocks, report.moves);
  }
  Table table({"reason", "line", "word"});
  for (const nc::read::Refused& refused : report.refused) {
    table.row({refused.reason, fmt::format("{}", refused.line), refused.word});
  }
  return fmt::format("refused after {} blocks; not accepted:\n", report.blocks) + table.text();
}

struct Options {
  ProgramOptions program;
  std::string machine;  ///< empty: only the program's words are checked
};

/// The program is read by the rules of its dialect; the machine adds axis letters and limits.
Outcome run_on(const Options& options, const kernel::machine::Machine* machine,
               Progress& progress) {
  const auto config = machine == nullptr ? program_config(options.program)
                                         : program_config(options.program, *machine);
  if (!config) {
    return refused(config.error());
  }
  nc::interpret::NoMoves nothing;
  std::optional<nc::plan::MachineCheck> check;
  if (machine != nullptr) {
    check.emplace(*machine, known_of(options.program));
  }
  nc::interpret::Sink& sink = check ? static_cast<nc::interpret::Sink&>(*check) : nothing;
  const auto report = run_program(options.program.file, *config, sink, progress);
  if (!report) {
    return refused(report.error());
  }
  Answer answer;
  put_report(answer, *report, options.program.file);
  if (machine != nullptr) {
    say_dialect(answer, options.program, *machine);
  }
  answer.json["moves"] = report->moves;
  answer.text = text_of(*report) + put_assumed(answer, *report);
  if (check) {
    answer.text += put_warnings(answer, check->warnings(), check->count());
  }
  return answer;
}

/// Without a machine the dialect must be given, because one G code means different things on
/// different controls.
Outcome run(const Options& options, Progress& progress) {
  if (options.machine.empty() && options.program.dialect.empty()) {
    return refused(bad_input("--dialect is required",
                             "give --dialect, or --machine with the machine the program is for"));
  }
  if (options.machine.empty()) {
    return run_on(options, nullptr, progress);
  }
  const auto machine = read_machine(options.machine);
  return machine ? run_on(options, &*machine, progress) : std::unexpected(machine.error());
}

}  // namespace
}  // namespace program_check

void add_verb_program_check(Session& session, Verb& verb) {
  auto options = std::make_shared<program_check::Options>();
  add_program_options(verb, options->program);
  verb.get_option("--dialect")->required(false);
  verb.add_option("--machine", options->machine,
                  "Machine file: sets dialect and axes, and checks the program against travel, "
                  "feeds and spindle; add --variables and --tools for the full check")
      ->option_text("FILE");
  session.on(verb,
             [options](Progress& progress) { return program_check::run(*options, progress); });
}

}  // namespace steadyrest::apps::cli
