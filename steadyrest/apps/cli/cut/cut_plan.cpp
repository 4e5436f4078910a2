// SPDX-License-Identifier: Apache-2.0
#include <string>
#include <utility>

#include <steadyrest/apps/cli/cut/cut_plan.hpp>
#include <steadyrest/apps/cli/shared/program_warnings.hpp>
#include <steadyrest/nc/plan/check/idle_override.hpp>
#include <steadyrest/nc/plan/path/path_builder.hpp>
#include <steadyrest/nc/plan/path/plan_program.hpp>
#include <steadyrest/nc/rewrite/original/original_path.hpp>

namespace steadyrest::apps::cli::cut {

using kernel::machine::Machine;
using kernel::outcome::Kind;
using nc::plan::PlannedPath;

namespace {

/// PlannedPath::programmed, where the program gives a tolerance.
Result<void> put_programmed(const std::string& file, const nc::interpret::Config& config,
                            const Machine& machine, PlannedPath& path) {
  if (!path.tolerant) {
    return {};
  }
  auto programmed = nc::plan::plan_programmed_file(file, config, machine);
  if (!programmed) {
    return std::unexpected(programmed.error());
  }
  path.programmed = std::make_shared<const PlannedPath>(std::move(*programmed));
  return {};
}

}  // namespace

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
  path->subprograms = report->subprograms;
  nc::rewrite::hold_against_original(nc::rewrite::read_text_marks(options.file, path->subprograms),
                                     options.file, *config, machine, *path);
  if (const auto done = put_programmed(options.file, *config, machine, *path); !done) {
    answer.refusals.push_back(done.error());
    answer.exit_code = kRefused;
    return std::unexpected(std::move(answer));
  }
  Planned out{std::make_shared<const PlannedPath>(std::move(*path)), check.warnings(),
              check.count(), *report};
  // If the feed override hardly acts because the axes never reach the programmed feed, the layer
  // has little to work with; that warning comes first.
  if (auto idle = nc::plan::idle_override(*out.path, machine.feed_override)) {
    out.warnings.insert(out.warnings.begin(), std::move(*idle));
    ++out.warning_count;
  }
  for (std::string& words : nc::rewrite::words_of(*out.path)) {
    out.warnings.insert(out.warnings.begin(), {.line = 1, .text = std::move(words)});
    ++out.warning_count;
  }
  return out;
}

}  // namespace steadyrest::apps::cli::cut
