// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <string>
#include <vector>

#include <Eigen/Core>

#include <steadyrest/thermal/offline/log/log.hpp>

namespace steadyrest::thermal::offline {

/// The readings of one displacement that a fit works with.
struct FitData {
  const Log* log = nullptr;        ///< its inputs are taken row by row, whatever rows are read
  std::size_t channel = 0;         ///< of the displacements
  std::vector<std::size_t> row;    ///< of the log, rising; the displacement is known there
  std::vector<double> time_s;      ///< of these rows
  Eigen::VectorXd reading_um;      ///< less the first one: where a gauge has its zero says nothing
  double zero_um = 0.0;            ///< the first one
  std::vector<std::size_t> fresh;  ///< rows here that are the first after a gap
  double noise_um = 0.0;
  double fastest_rev_s = 0.0;  ///< of the spindle, from the first of the rows to the last

  /// Pieces that are left out in turn: from the spindle's start to its next, or, where it starts
  /// less than three times, pieces of equal time; none of less than half an hour. Fewer than
  /// kLeastBlocks: there are none.
  struct Block {
    std::size_t begin = 0;  ///< of the rows here
    std::size_t end = 0;
  };
  std::vector<Block> block;

  /// The blocks that the others can forecast: their spindle turns no faster than 1.2 times theirs.
  /// All of them where that leaves less than two.
  [[nodiscard]] std::vector<std::size_t> within_reach() const;
  [[nodiscard]] std::size_t rows() const noexcept { return row.size(); }
  [[nodiscard]] double hours() const noexcept {
    return time_s.empty() ? 0.0 : (time_s.back() - time_s.front()) / 3600.0;
  }
};

inline constexpr std::size_t kLeastBlocks = 3;
/// A stop of less than this does not end a block.
inline constexpr double kRest_s = 1200.0;
/// A log is thinned to about that many rows, but to no longer steps than a minute … two.
inline constexpr std::size_t kFitRows = 1400;

[[nodiscard]] FitData fit_data(const Log& log, std::size_t channel, double from_s, double to_s);

/// The longest time at one speed other than 0.
[[nodiscard]] double longest_run_s(const Log& log, double from_s, double to_s);

}  // namespace steadyrest::thermal::offline
