// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <functional>
#include <vector>

#include <steadyrest/chatter/offline/process/process.hpp>
#include <steadyrest/chatter/offline/process/speed_profile.hpp>
#include <steadyrest/kernel/outcome/result.hpp>

/// The stability map: ln ρ over speed × depth. Its border: border_line.hpp.
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
};

/// `progress` gets the share done, 0 … 1, rising, from one thread at a time; may be empty. Refuses
/// what DepthLine refuses, depths that do not rise from 0 or above, and more than 10 million
/// points.
[[nodiscard]] kernel::outcome::Result<LobeMap> lobe_map(
    const Process& process, const LobeMapConfig& config,
    const std::function<void(double)>& progress);

}  // namespace steadyrest::chatter::offline
