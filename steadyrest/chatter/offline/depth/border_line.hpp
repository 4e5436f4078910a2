// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <functional>
#include <optional>
#include <vector>

#include <steadyrest/chatter/offline/process/process.hpp>
#include <steadyrest/chatter/offline/process/speed_profile.hpp>
#include <steadyrest/kernel/outcome/result.hpp>

/// The border of the lobes as a line: the lowest depth with ρ = 1 over the speed.
///
/// Spans between the given speeds are halved until the line through the points is within 1 % of the
/// depth plus 0.05 % of the greatest depth of the border; cusps between lobes and jumps onto
/// islands are located to 3e-4 of a lobe's width in speed. It starts from six points on each lobe
/// (each wave more or fewer of the fastest mode between two teeth), so no lobe is missed, however
/// few speeds are given. A span counts as settled when its middle and the previous one lie on the
/// line. The search for each border starts at half of the lowest one found.
namespace steadyrest::chatter::offline {

struct BorderLineConfig {
  std::vector<double> speed_rev_s;  ///< rising, each > 0, at least one; all become points
  double most_depth_mm = 1.0;       ///< > 0
  Modulation modulation;
  unsigned threads = 0;  ///< 0: as many as the machine has
};

struct BorderLine {
  std::vector<double> speed_rev_s;              ///< rising
  std::vector<std::optional<double>> depth_mm;  ///< to 1e-9; empty: stable up to the greatest depth
  /// False: the allowed work was spent before the whole line was within tolerance; the worst places
  /// were refined first. Allowed are 20 000 points, or, where each depth needs the whole map of the
  /// cut, as many as there are speeds, at least 200.
  bool settled = true;
};

/// `progress` as in lobe_map(). Refuses what DepthLine refuses, and speeds that do not rise.
[[nodiscard]] kernel::outcome::Result<BorderLine> border_line(
    const Process& process, const BorderLineConfig& config,
    const std::function<void(double)>& progress = {});

}  // namespace steadyrest::chatter::offline
