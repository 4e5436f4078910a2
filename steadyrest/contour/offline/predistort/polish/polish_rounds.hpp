// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <functional>
#include <vector>

#include <steadyrest/contour/offline/predistort/polish/corner_legs.hpp>
#include <steadyrest/contour/offline/predistort/polish/polish.hpp>
#include <steadyrest/kernel/outcome/result.hpp>

namespace steadyrest::contour::offline {

/// Pieces tried on the whole program.
struct TriedPieces {
  double score_mm = 0.0;  ///< the lower, the better
  double time = 1.0;      ///< in terms of what is permitted
};
using TryPieces = std::function<kernel::outcome::Result<TriedPieces>(const std::vector<Piece>&)>;

inline constexpr std::size_t kMostPieces = 5000;  ///< CAM programs of many lines stay
inline constexpr int kPolishRuns = 27;            ///< sweeps and pieces tried, at most

struct PolishSweeps {
  int most = 7;
  int first_secants = 5;  ///< until the legs at corners are right
  bool patient = false;   ///< a sweep that wins nothing is not the last
  int unites_in = 0;  ///< the sweep that makes one piece of two: later, it costs less of the error
};

/// Sweeps of windows (polished()) and, between them, stops led beyond (CornerLegs), as long as that
/// helps. Where the program takes too long a second costs more in the next sweep. `starts` are
/// those of the last run: each attempt changes them. Refused: what `attempt` refuses.
[[nodiscard]] kernel::outcome::Result<void> polish_rounds(PolishTask task,
                                                          std::vector<Piece> pieces,
                                                          const std::vector<BlockStart>& starts,
                                                          const TryPieces& attempt,
                                                          const PolishSweeps& how = {});

/// The legs of a task's corners, none yet.
[[nodiscard]] CornerLegs corner_legs(const PolishTask& task);

/// The same, with the pieces and legs in hand; `pieces` are then those of the last sweep.
[[nodiscard]] kernel::outcome::Result<void> polish_sweeps(
    PolishTask& task, std::vector<Piece>& pieces, CornerLegs& legs,
    const std::vector<BlockStart>& starts, const TryPieces& attempt, const PolishSweeps& how);

}  // namespace steadyrest::contour::offline
