// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include <steadyrest/apps/cli/program/ahead/changed_program.hpp>
#include <steadyrest/apps/cli/program/ahead/choose_speeds.hpp>
#include <steadyrest/apps/cli/shared/session.hpp>
#include <steadyrest/nc/rewrite/replace/replace.hpp>
#include <steadyrest/nc/rewrite/replace/spindle_words.hpp>

/// Spindle speeds that keep the cuts stable, with the feed per tooth kept.
namespace steadyrest::apps::cli {

struct SpeedOptions {
  std::string process;
  double depth_mm = 0.0;
  std::optional<std::int64_t> tool;
};

/// Adds --process, --depth-mm and --tool; the first two need each other.
void add_speed_options(Verb& verb, SpeedOptions& options);

struct SpeedsAhead {
  std::vector<nc::rewrite::SpindleSpan> spans;
  std::vector<SpeedChoice> choices;
  std::vector<double> ratio;
  nc::rewrite::NewLines lines;
};

/// Asks the planner for each S word; a speed whose feed cannot be kept stays. Refused: what the
/// process file, the planner or the rewriter refuses.
[[nodiscard]] std::expected<SpeedsAhead, Refusals> speeds_ahead(const SpeedOptions& options,
                                                                const SourceProgram& program,
                                                                const std::string& file,
                                                                Progress& progress);

/// The key `cuts[]`, and the same for people.
[[nodiscard]] std::string put_speeds(Answer& answer, const SpeedsAhead& done);

}  // namespace steadyrest::apps::cli
