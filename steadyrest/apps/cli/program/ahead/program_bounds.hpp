// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>

#include <steadyrest/apps/cli/program/ahead/changed_program.hpp>

namespace steadyrest::apps::cli {

/// Longest programs that are run on the servo model, many times over: a path keeps every sample, so
/// memory (2.5 GB at 20 1/s) bounds it; feeds only take their time.
inline constexpr double kLongestPath_s = 8.0 * 3600.0;
inline constexpr double kLongestFeeds_s = 24.0 * 3600.0;

/// Refused, before any of the work: a program that takes longer than `longest_s` at its own feeds;
/// one that takes an axis past its travel, as far as its place in the travel is known.
[[nodiscard]] Result<void> within_bounds(const SourceProgram& program, const std::string& file,
                                         double longest_s);

}  // namespace steadyrest::apps::cli
