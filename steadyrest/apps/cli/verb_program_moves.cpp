// SPDX-License-Identifier: Apache-2.0
#include <cerrno>
#include <cstdio>
#include <cstring>
#include <memory>

#include <fmt/core.h>

#include <steadyrest/apps/cli/program_options.hpp>
#include <steadyrest/apps/cli/verb_program_moves.hpp>
#include <steadyrest/nc/interpret/move_table.hpp>

namespace steadyrest::apps::cli {
namespace {

using kernel::outcome::Kind;
using kernel::outcome::Refusal;
using nc::interpret::MoveTable;

struct Options {
  ProgramOptions program;
  std::string output;
};

struct CloseFile {
  void operator()(std::FILE* file) const noexcept { std::fclose(file); }
};
using File = std::unique_ptr<std::FILE, CloseFile>;

Refusal cannot_write(const std::string& path) {
  return {Kind::unavailable, path, 0, std::string{"cannot be written: "} + std::strerror(errno),
          "check the folder, the rights and the disk space"};
}

/// Streams the table into `out`; the answer has the counts and the refusals.
Outcome stream(const Options& options, const nc::interpret::Config& config, std::FILE* out,
               const std::string& name) {
  MoveTable table(out);
  const auto report = nc::interpret::run_file(options.program.file, config, table);
  if (!report) {
    return refused(report.error());
  }
  if (!table.finish()) {
    return refused(cannot_write(name));
  }
  Answer answer;
  put_report(answer, *report, options.program.file);
  answer.json["moves"] = report->moves;
  return answer;
}

// Without -o the table itself is the text for people, written as it arises: a program of ten
// million lines must not be held in memory. With --json stdout belongs to the JSON object.
Outcome run(const Options& options, bool json) {
  const auto config = program_config(options.program);
  if (!config) {
    return refused(config.error());
  }
  if (options.output.empty() && !json) {
    return stream(options, *config, stdout, "stdout");
  }
  const std::string path = options.output.empty() ? "/dev/null" : options.output;
  const File file(std::fopen(path.c_str(), "wb"));
  if (!file) {
    return refused(cannot_write(path));
  }
  return stream(options, *config, file.get(), path);
}

}  // namespace

void add_verb_program_moves(Session& session) {
  CLI::App& group = session.group("program", "NC programs");
  CLI::App& verb = session.verb(
      group, "moves", "Lists the moves of an NC program as CSV, in mm, degrees and mm/min",
      "program moves examples/programs/rib-pocket.ngc --dialect linuxcnc");
  auto options = std::make_shared<Options>();
  add_program_options(verb, options->program);
  verb.add_option("-o,--output", options->output, "Write the table to this file, not to stdout");
  session.on(verb,
             [options, &session](Progress& /*progress*/) { return run(*options, session.json()); });
}

}  // namespace steadyrest::apps::cli
