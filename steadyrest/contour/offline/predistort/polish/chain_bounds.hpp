// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vector>

#include <steadyrest/contour/offline/predistort/shape/piece.hpp>
#include <steadyrest/nc/plan/path/planned_path.hpp>

namespace steadyrest::contour::offline {

/// How far a window may take its pieces.
class ChainBounds {
 public:
  struct Config {
    const nc::plan::PlannedPath& path;  ///< of the original
    double most_shift_mm = 0.5;         ///< from the path
    double gain_1_s = 20.0;             ///< of the softest axis
  };
  explicit ChainBounds(const Config& config) : config_(config) {}

  /// A piece is farther from the path than permitted, or a block ends too far from where the
  /// original's does.
  [[nodiscard]] bool left_by(const std::vector<Piece>& pieces) const;

 private:
  [[nodiscard]] double from_block_end_mm(const Piece& last) const;
  [[nodiscard]] double most_from_end_mm(const Piece& last) const;

  Config config_;
};

}  // namespace steadyrest::contour::offline
