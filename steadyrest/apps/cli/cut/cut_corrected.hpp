// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <memory>
#include <string>
#include <vector>

#include <steadyrest/apps/cli/cut/cut_plan.hpp>
#include <steadyrest/apps/cli/program/ahead/changed_program.hpp>
#include <steadyrest/trial/cut/original.hpp>
#include <steadyrest/trial/cut/report_data.hpp>

/// The part cut by a corrected text: what `program correct` and `program feeds` would write.
namespace steadyrest::apps::cli::cut {

struct CorrectTask {
  const ProgramOptions& program;
  std::string machine_file;
  const kernel::machine::Machine& machine;
  const CLI::App& verb;
};

/// One text, planned, and held against its original.
struct Corrected {
  trial::cut::Way way = trial::cut::Way::text;
  std::string command;
  PathPointer path;
  std::shared_ptr<const trial::cut::Original> against;
  std::vector<std::uint32_t> origin;  ///< the original's line, by line of the text
};

struct CorrectedWays {
  std::vector<Corrected> ways;
  std::vector<std::string> not_possible;  ///< which way, and why
  nc::rewrite::CutBlocks blocks;          ///< of the original
};

/// All texts, worked out side by side. What refuses a text is in `not_possible`.
[[nodiscard]] CorrectedWays corrected_ways(const CorrectTask& task, Progress& progress);

}  // namespace steadyrest::apps::cli::cut
