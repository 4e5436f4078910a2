// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include <steadyrest/contour/offline/predistort/shape/piece.hpp>
#include <steadyrest/kernel/machine/axis.hpp>
#include <steadyrest/nc/plan/path/planned_path.hpp>

namespace steadyrest::contour::offline {

/// How far pieces are from the path that they replace.
struct Shift {
  double largest_mm = 0.0;
  std::vector<std::uint32_t> too_far;  ///< lines with a piece beyond the bound, ascending
};

/// At five points of each piece, to the nearest point of the path within a reach of four times the
/// bound (at least 1 mm) of where the piece belongs.
[[nodiscard]] Shift shift_of(const nc::plan::PlannedPath& path, const std::vector<Piece>& pieces,
                             double bound_mm);

/// Lines with a piece that takes X, Y or Z past an end of its travel by more than the path itself
/// does, ascending. Arcs count by at most (1 − cos(sweep/128))·R too much.
[[nodiscard]] std::vector<std::uint32_t> past_travel(const nc::plan::PlannedPath& path,
                                                     const std::vector<Piece>& pieces,
                                                     std::span<const kernel::machine::Axis> axes);

}  // namespace steadyrest::contour::offline
