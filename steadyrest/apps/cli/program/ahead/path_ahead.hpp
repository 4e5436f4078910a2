// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <string>
#include <vector>

#include <steadyrest/apps/cli/program/ahead/changed_program.hpp>
#include <steadyrest/apps/cli/program/ahead/learnt_parts.hpp>
#include <steadyrest/apps/cli/shared/session.hpp>
#include <steadyrest/contour/offline/predistort/predistort.hpp>

/// The path that the axes must be commanded so that the tool runs on the programmed one.
namespace steadyrest::apps::cli {

struct PathOptions {
  double max_error_mm = 0.01;
  /// None: by settle_shift().
  // NOLINTNEXTLINE(readability-redundant-member-init)
  std::optional<double> max_shift_mm = std::nullopt;
  double gain_uncertainty_percent = 5.0;
  // NOLINTNEXTLINE(readability-redundant-member-init)
  std::optional<double> lag_uncertainty_percent = std::nullopt;
  double max_time_percent = 2.0;
  bool hold = false;
  bool staged = false;   ///< other lines have been replaced before: feeds are theirs
  bool explains = true;  ///< causes, cures and settings are asked for
  LearningOptions learning;
};

/// Adds --max-error-mm, --max-shift-mm, --gain-uncertainty-percent, --lag-uncertainty-percent,
/// --max-time-percent, --hold-limit, --from-record and --cut-program.
void add_path_options(Verb& verb, PathOptions& options);

/// Where no largest shift was asked for: 0.5 mm, which is enough for all but slow servos, and 2 mm
/// for a program whose predicted error is beyond 0.25 mm, since a command leaves the path by as
/// much as the tool would.
[[nodiscard]] kernel::outcome::Result<void> settle_shift(PathOptions& options,
                                                         const SourceProgram& program);

/// For the mark in the program, and what it says of `changes`.
[[nodiscard]] std::string changes_of(const PathOptions& options);
[[nodiscard]] std::vector<nc::rewrite::Told> told_of(const PathOptions& options);

/// After settle_shift(). `file`: the program itself, or a stage of it.
[[nodiscard]] kernel::outcome::Result<contour::offline::Predistorted> path_ahead(
    const PathOptions& options, const SourceProgram& program, const std::string& file,
    std::vector<nc::rewrite::Told> told, Progress& progress);

/// The keys of the prediction, `uncertain`, `largest_shift_mm`, `too_far[]`, `past_travel[]`,
/// `not_better[]`, `slower` and `learnt[]`, and the same for people.
[[nodiscard]] std::string put_path(Answer& answer, const contour::offline::Predistorted& done,
                                   const PathOptions& options);

}  // namespace steadyrest::apps::cli
