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

/// The travel of X, Y and Z, widened to what the path itself uses.
class Travel {
 public:
  Travel(const nc::plan::PlannedPath& path, std::span<const kernel::machine::Axis> axes);

  /// Lines with a piece that leaves it, ascending.
  [[nodiscard]] std::vector<std::uint32_t> left_by(const std::vector<Piece>& pieces) const;

 private:
  kernel::signal::Point low_mm_{};
  kernel::signal::Point high_mm_{};
};

}  // namespace steadyrest::contour::offline
