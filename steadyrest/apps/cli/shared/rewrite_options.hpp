// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <expected>
#include <string>
#include <vector>

#include <CLI/CLI.hpp>

#include <steadyrest/apps/cli/shared/program_options.hpp>
#include <steadyrest/apps/cli/shared/session.hpp>
#include <steadyrest/kernel/machine/machine.hpp>
#include <steadyrest/nc/interpret/state/config.hpp>
#include <steadyrest/nc/rewrite/text/mark.hpp>
#include <steadyrest/nc/rewrite/text/plan_file.hpp>
#include <steadyrest/nc/rewrite/text/settings.hpp>

namespace steadyrest::apps::cli {

inline constexpr int kNoParameter = -1;

/// Options of `program compensate` and `program verify`, apart from their files.
struct RewriteOptions {
  ProgramOptions program;
  std::string plan;
  std::string machine;  ///< empty: the one named by the plan
  std::string control;
  int r_parameter = kNoParameter;
  double window_s = 60.0;
  const CLI::App* verb = nullptr;  ///< tells which options were given
};

/// Everything read.
struct RewriteTask {
  nc::rewrite::Plan plan;
  kernel::machine::Machine machine;
  nc::interpret::Config config;
  nc::rewrite::Settings settings;
};

/// How corrections are written into programs of this dialect: by the command line, else by the
/// machine file.
[[nodiscard]] std::expected<nc::rewrite::Way, Refusals> way_of(
    const RewriteOptions& options, const kernel::machine::Machine& machine,
    nc::read::Dialect program);

/// The machine file, which the plan may name.
[[nodiscard]] std::vector<std::string> files_of(const RewriteOptions& options);

/// Adds everything except the programs' own names.
void add_rewrite_options(Verb& verb, RewriteOptions& options);
[[nodiscard]] std::expected<RewriteTask, Refusals> read_rewrite_task(const RewriteOptions& options,
                                                                     Progress& progress);
/// The options with what the mark of a changed program supplies. Refused: an option that
/// contradicts it.
[[nodiscard]] std::expected<RewriteOptions, Refusals> with_told(
    const RewriteOptions& options, const std::string& changed,
    const std::vector<nc::rewrite::Told>& mark);
/// For a changed program: its mark supplies what is not given, and must not contradict what is.
[[nodiscard]] std::expected<RewriteTask, Refusals> read_rewrite_task(const RewriteOptions& options,
                                                                     const std::string& changed,
                                                                     Progress& progress);

}  // namespace steadyrest::apps::cli
