// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <functional>
#include <string>
#include <vector>

#include <steadyrest/apps/cli/program/ahead/changed_program.hpp>
#include <steadyrest/contour/offline/causes/causes.hpp>
#include <steadyrest/nc/rewrite/replace/replace.hpp>

/// What stays over the limit, why, and the cheapest cure: in the words of the verbs.
namespace steadyrest::apps::cli {

/// Places whose cures are tried: each takes some runs of a few seconds of the program.
inline constexpr std::size_t kMostCured = 8;

/// The best cure with its price, or what remains with it; empty: none was found.
[[nodiscard]] std::string cure_words(const contour::offline::OverLine& over, double limit_mm);

/// A path that is run on the servo model, and what it is judged by.
struct RunPath {
  const nc::plan::PlannedPath& path;
  const nc::plan::PlannedPath& original;
  contour::offline::PathMap map;
  const std::vector<std::uint32_t>& origin;  ///< the original's line, by line; empty: the same
  /// ModelRun::unknown
  std::function<kernel::signal::Point(double foot_mm)> unknown = nullptr;
};

/// What stays over the limit. `held`: a text that holds it better, whose feeds are a cure; null:
/// none.
[[nodiscard]] Result<std::vector<contour::offline::OverLine>> over_lines(
    const kernel::machine::Machine& machine, const nc::rewrite::CutBlocks& blocks,
    const RunPath& run, const RunPath* held, double limit_mm);

}  // namespace steadyrest::apps::cli
