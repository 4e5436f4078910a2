// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <optional>
#include <vector>

#include <steadyrest/chatter/offline/process/process.hpp>
#include <steadyrest/kernel/outcome/result.hpp>

/// The best constant speeds of a cut on a spindle, one from each lobe.
///
/// The cusp between two lobes is the deepest place but no place to cut: half a percent of the
/// frequency away is the flank. A speed n is worth the lowest border within n·(1 ± tolerance),
/// since changing all frequencies amounts to changing the speed; the best speeds are the highest
/// maxima of that worth, the faster of equals first, separated by a dip of at least 2 %.
namespace steadyrest::chatter::offline {

struct BestSpeedsConfig {
  double min_rev_s = 0.0;         ///< of the spindle, ≥ 0
  double max_rev_s = 200.0;       ///< > min_rev_s
  double most_depth_mm = 1.0;     ///< borders are sought up to here, > 0
  double tolerance_ratio = 0.01;  ///< of the frequencies, 0 … 0.2
  std::size_t most = 5;           ///< speeds
};

struct BestSpeed {
  double speed_rev_s = 0.0;
  std::optional<double> limit_depth_mm;  ///< the border there; empty: none up to most_depth_mm
  std::optional<double> sure_depth_mm;   ///< lowest border within the tolerance; empty: likewise
};

/// The best first. Lobes beyond 25 waves between two teeth are too narrow to aim at and left out,
/// unless the spindle is too slow for any others. Empty where the solver reaches no speed.
[[nodiscard]] kernel::outcome::Result<std::vector<BestSpeed>> best_speeds(
    const Process& process, const BestSpeedsConfig& config);

}  // namespace steadyrest::chatter::offline
