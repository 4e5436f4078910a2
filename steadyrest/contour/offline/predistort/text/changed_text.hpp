// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <map>
#include <string>
#include <vector>

#include <steadyrest/contour/offline/predistort/shape/piece.hpp>
#include <steadyrest/kernel/machine/machine.hpp>
#include <steadyrest/kernel/outcome/result.hpp>
#include <steadyrest/nc/interpret/state/config.hpp>
#include <steadyrest/nc/plan/path/planned_path.hpp>
#include <steadyrest/nc/rewrite/replace/cut_blocks.hpp>
#include <steadyrest/nc/rewrite/replace/replace.hpp>

namespace steadyrest::contour::offline {

/// A changed program, its planned path, and the original path lengths along it.
struct Changed {
  nc::rewrite::NewLines lines;
  nc::rewrite::Replaced replaced;
  nc::plan::PlannedPath path;
  /// By segment of the path: original path length at its start and end.
  std::vector<double> start_mm;
  std::vector<double> end_mm;
};

/// Dwells, s, by the line of the block that they are before.
using Waits = std::map<std::uint32_t, double>;

/// What is needed to write pieces into a program and to plan it again.
struct Program {
  const std::string& file;
  const nc::interpret::Config& config;
  const kernel::machine::Machine& machine;
  const nc::rewrite::CutBlocks& blocks;
  const nc::plan::PlannedPath& path;  ///< of the original
  const std::vector<nc::rewrite::Told>& told;
  const Waits& waits;
};

/// The program with the pieces in place of their blocks, read and planned as the control would. A
/// wait is the first line in place of a block that may change.
/// Refused: what the interpreter or the planner refuses of it.
[[nodiscard]] kernel::outcome::Result<Changed> write_pieces(const Program& program,
                                                            const std::vector<Piece>& pieces);

}  // namespace steadyrest::contour::offline
