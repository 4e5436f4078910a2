// SPDX-License-Identifier: Apache-2.0
#include <fmt/core.h>

#include <steadyrest/apps/cli/program/ahead/over_lines.hpp>
#include <steadyrest/apps/cli/program/ahead/predicted_change.hpp>

namespace steadyrest::apps::cli {

using contour::offline::OverLine;
using contour::offline::OverTask;

namespace {

OverTask task_of(const kernel::machine::Machine& machine, const nc::rewrite::CutBlocks& blocks,
                 const RunPath& run, double limit_mm) {
  return {
      .machine = machine,
      .path = run.path,
      .original = run.original,
      .map = run.map,
      .limit_mm = limit_mm,
      .origin =
          [&run](std::uint32_t line) { return line < run.origin.size() ? run.origin[line] : line; },
      .kept =
          [&blocks](std::uint32_t line) {
            const auto* block = blocks.find(line);
            return block == nullptr || block->stays == nc::rewrite::Stays::free
                       ? std::string{}
                       : std::string(nc::rewrite::sentence(block->stays));
          },
      .unknown = run.unknown};
}

}  // namespace

std::string cure_words(const OverLine& over, double limit_mm) {
  if (over.cures.empty()) {
    return {};
  }
  const auto& cure = over.cures.front();
  return cure.holds(limit_mm) ? fmt::format("{}: {:+.2f} s", cure.what, cure.seconds)
                              : fmt::format("{} leaves {}: {:+.2f} s", cure.what,
                                            in_um(cure.leaves_mm), cure.seconds);
}

Result<std::vector<OverLine>> over_lines(const kernel::machine::Machine& machine,
                                         const nc::rewrite::CutBlocks& blocks, const RunPath& run,
                                         const RunPath* held, double limit_mm) {
  const OverTask task = task_of(machine, blocks, run, limit_mm);
  auto over = contour::offline::lines_over(task, kMostCured);
  if (!over || over->empty() || held == nullptr) {
    return over;
  }
  const auto now = contour::offline::line_runs(task);
  const auto other =
      now ? contour::offline::line_runs(task_of(machine, blocks, *held, limit_mm)) : now;
  if (!other) {
    return std::unexpected(other.error());
  }
  contour::offline::add_cure(*over, *now, *other, "--hold-limit", limit_mm);
  return over;
}

}  // namespace steadyrest::apps::cli
