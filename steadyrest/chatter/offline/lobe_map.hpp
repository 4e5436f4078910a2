// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <functional>
#include <optional>
#include <vector>

#include <steadyrest/chatter/offline/process.hpp>
#include <steadyrest/chatter/offline/speed_profile.hpp>
#include <steadyrest/kernel/outcome/result.hpp>

/// The stability map: ln ρ over speed × depth, and the border ρ = 1 of each speed.
namespace steadyrest::chatter::offline {

struct LobeMapConfig {
  std::vector<double> speed_rev_s;  ///< each > 0, at least one
  std::vector<double> depth_mm;     ///< rising, from 0 or above, the last > 0
  Modulation modulation;
  unsigned threads = 0;  ///< 0: as many as the machine has
};

struct LobeMap {
  std::vector<double> speed_rev_s;
  std::vector<double> depth_mm;
  /// [speed·depths + depth], over one period of the law; over one pass when constant.
  std::vector<double> log_radius;
  /// The lowest crossing of ρ = 1 at each speed, to 1e-9, between depths of the map or in an island
  /// about one of them (island_mm); empty: stable.
  std::vector<std::optional<double>> border_mm;
};

/// `progress` gets the share done, 0 … 1, rising, from one thread at a time; may be empty. Refuses
/// what DepthLine refuses and depths that do not rise from 0 or above.
[[nodiscard]] kernel::outcome::Result<LobeMap> lobe_map(
    const Process& process, const LobeMapConfig& config,
    const std::function<void(double)>& progress);

}  // namespace steadyrest::chatter::offline
