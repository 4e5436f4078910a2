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
/// Between the speeds that are asked for it is halved until the line through its points is within
/// 1 % of the depth and 0.05 % of the greatest depth of the border, cusps between lobes and jumps
/// onto islands included, there to 3e-4 of a lobe's width in speed. It starts from six points on
/// each lobe (on each wave that the fastest mode makes more or fewer between two teeth), so that no
/// lobe is passed over, however few speeds are given. A span counts as settled when its middle and
/// the one before lie on the line. Between them the border is sought from half of its lowest depth
/// up.
namespace steadyrest::chatter::offline {

struct BorderLineConfig {
  std::vector<double> speed_rev_s;  ///< rising, each > 0, at least one; all are in the line
  double most_depth_mm = 1.0;       ///< > 0
  Modulation modulation;
  unsigned threads = 0;  ///< 0: as many as the machine has
};

struct BorderLine {
  std::vector<double> speed_rev_s;              ///< rising
  std::vector<std::optional<double>> depth_mm;  ///< to 1e-9; empty: stable up to the greatest depth
  /// False: the work allowed (20 000 points, where each depth needs the whole map of the cut as
  /// many as there are speeds, 200 at least) was spent before all of it was within tolerance; the
  /// worst places were refined first.
  bool settled = true;
};

/// `progress` as lobe_map() has it. Refuses what DepthLine refuses, and speeds that do not rise.
[[nodiscard]] kernel::outcome::Result<BorderLine> border_line(
    const Process& process, const BorderLineConfig& config,
    const std::function<void(double)>& progress = {});

}  // namespace steadyrest::chatter::offline
