// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <expected>
#include <string>
#include <vector>

#include <CLI/CLI.hpp>

#include <steadyrest/apps/cli/shared/program_options.hpp>
#include <steadyrest/apps/cli/shared/session.hpp>
#include <steadyrest/kernel/machine/machine.hpp>
#include <steadyrest/nc/interpret/state/config.hpp>
#include <steadyrest/nc/plan/check/machine_check.hpp>
#include <steadyrest/nc/plan/path/planned_path.hpp>
#include <steadyrest/nc/rewrite/replace/cut_blocks.hpp>
#include <steadyrest/nc/rewrite/text/mark.hpp>

/// What the verbs share that replace blocks of a program.
namespace steadyrest::apps::cli {

/// A program that will be changed.
struct SourceProgram {
  kernel::machine::Machine machine;
  nc::interpret::Config config;
  nc::plan::PlannedPath path;
  nc::rewrite::CutBlocks blocks;
  std::vector<nc::plan::Warning> past_travel;  ///< moves that take an axis past its travel
};

/// Reads the machine, then plans the program. Refused: what the interpreter or the planner refuses,
/// a program with blocks replaced already, and one that does not cut.
[[nodiscard]] std::expected<SourceProgram, Refusals> read_source_program(
    const ProgramOptions& options, const std::string& machine);

/// The program's path with each line's feed scaled by `ratio` (by line; 1 beyond its end). The path
/// keeps the programmed feeds: only the rounding of its corners differs.
[[nodiscard]] Result<nc::plan::PlannedPath> plan_at_feeds(const SourceProgram& program,
                                                          const std::string& file,
                                                          const std::vector<double>& ratio);

/// For the changed program's mark: what it is, how it was read, and `more`.
[[nodiscard]] std::expected<std::vector<nc::rewrite::Told>, Refusals> told_of_change(
    const std::string& changes, const CLI::App& verb, const SourceProgram& program,
    std::vector<nc::rewrite::Told> more);

/// What a verb writes into a block.
enum class Rewrites : std::uint8_t { path, feeds };

/// The key `kept[]`: `reason` and `lines[]` of the blocks that cut and had to stay. The text for
/// people, empty for none.
[[nodiscard]] std::string put_kept(Answer& answer, const nc::rewrite::CutBlocks& blocks,
                                   Rewrites rewrites);

}  // namespace steadyrest::apps::cli
