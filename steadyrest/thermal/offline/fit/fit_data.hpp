// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <string>
#include <vector>

#include <Eigen/Core>

#include <steadyrest/thermal/offline/log/log.hpp>

namespace steadyrest::thermal::offline {

/// The readings of one displacement used by a fit.
struct FitData {
  const Log* log = nullptr;        ///< its inputs are used row by row, whichever rows are read
  std::size_t channel = 0;         ///< of the displacements
  std::vector<std::size_t> row;    ///< of the log, ascending; the displacement is known there
  std::vector<double> time_s;      ///< of these rows
  Eigen::VectorXd reading_um;      ///< less the first one: a gauge's zero is arbitrary
  double zero_um = 0.0;            ///< the first one
  std::vector<std::size_t> fresh;  ///< rows here that are the first after a gap
  double noise_um = 0.0;
  double fastest_rev_s = 0.0;  ///< of the spindle, from the first of the rows to the last

  /// Pieces left out in turn: from one spindle start to the next, or, with fewer than three starts,
  /// pieces of equal time; none shorter than half an hour. With fewer than kLeastBlocks there are
  /// none.
  struct Block {
    std::size_t begin = 0;  ///< of the rows here
    std::size_t end = 0;
  };
  std::vector<Block> block;

  /// The blocks that the others can forecast: their spindle turns at most 1.2 times as fast as the
  /// others'. All of them if that leaves fewer than two.
  [[nodiscard]] std::vector<std::size_t> within_reach() const;
  [[nodiscard]] std::size_t rows() const noexcept { return row.size(); }
  [[nodiscard]] double hours() const noexcept {
    return time_s.empty() ? 0.0 : (time_s.back() - time_s.front()) / 3600.0;
  }
};

inline constexpr std::size_t kLeastBlocks = 3;
/// A shorter stop does not end a block.
inline constexpr double kRest_s = 1200.0;
/// A log is thinned to about this many rows, but to steps of at most one to two minutes.
inline constexpr std::size_t kFitRows = 1400;

[[nodiscard]] FitData fit_data(const Log& log, std::size_t channel, double from_s, double to_s);

/// The longest time at one speed other than 0.
[[nodiscard]] double longest_run_s(const Log& log, double from_s, double to_s);

}  // namespace steadyrest::thermal::offline
