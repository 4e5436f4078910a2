// SPDX-License-Identifier: Apache-2.0
#include <memory>
#include <optional>
#include <utility>

#include <steadyrest/apps/cli/program/verb_program_moves.hpp>
#include <steadyrest/apps/cli/shared/machine_option.hpp>
#include <steadyrest/apps/cli/shared/program_options.hpp>
#include <steadyrest/kernel/file/output_file.hpp>
#include <steadyrest/nc/interpret/state/move_table.hpp>

namespace steadyrest::apps::cli {
namespace program_moves {
namespace {

using nc::interpret::MoveTable;

struct Options {
  ProgramOptions program;
  std::string output;
  std::string machine;  ///< empty: a control without settings of its own
};

// Without -o the table itself is the text for people, written as it arises: a program of ten
// million lines must not be held in memory. With --json stdout belongs to the JSON object.
Outcome run(const Options& options, bool json, Progress& progress) {
  if (options.machine.empty() && options.program.dialect.empty()) {
    return refused(bad_input("--dialect is required",
                             "give --dialect, or --machine with the machine the program is for"));
  }
  std::optional<kernel::machine::Machine> machine;
  if (!options.machine.empty()) {
    auto read = read_machine(options.machine);
    if (!read) {
      return std::unexpected(read.error());
    }
    machine = std::move(*read);
  }
  const auto config =
      machine ? program_config(options.program, *machine) : program_config(options.program);
  if (!config) {
    return refused(config.error());
  }
  auto out = table_output(options.output, json);
  if (!out) {
    return refused(out.error());
  }
  MoveTable table(*out);
  // The table and a bar on one screen would spoil each other.
  const bool on_screen = options.output.empty() && !json;
  const auto report = on_screen ? nc::interpret::run_file(options.program.file, *config, table)
                                : run_program(options.program.file, *config, table, progress);
  if (!report) {
    return refused(report.error());
  }
  table.finish();
  // The moves up to a refusal are no reason to replace an older table of all.
  const bool whole = report->refused.empty();
  if (const auto written = whole ? out->commit() : out->flush(); !written) {
    return refused(written.error());
  }
  Answer answer;
  put_report(answer, *report, options.program.file);
  if (machine) {
    say_dialect(answer, options.program, *machine);
  }
  answer.json["moves"] = report->moves;
  answer.notes += put_assumed(answer, *report);
  return answer;
}

}  // namespace
}  // namespace program_moves

void add_verb_program_moves(Session& session, Verb& verb) {
  auto options = std::make_shared<program_moves::Options>();
  add_program_options(verb, options->program);
  verb.get_option("--dialect")->required(false);
  verb.add_option("--machine", options->machine,
                  "Machine file: sets dialect and axes, and what its control makes of programs")
      ->option_text("FILE");
  verb.writes(
      "-o,--output", options->output, "Write the table to this file instead of stdout",
      csv_content("a table of moves (CSV)", {std::string(program_moves::MoveTable::kHead)}));
  session.on(verb, [options, &session](Progress& progress) {
    return program_moves::run(*options, session.json(), progress);
  });
}

}  // namespace steadyrest::apps::cli
