// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vector>

#include <steadyrest/chatter/offline/process/process.hpp>
#include <steadyrest/chatter/online/speed_table.hpp>
#include <steadyrest/kernel/machine/machine.hpp>
#include <steadyrest/kernel/outcome/result.hpp>

namespace steadyrest::chatter::offline {

/// Settings of a table without depths: the override's steps and the limits of the machine.
[[nodiscard]] online::SpeedTable::Config steps_of(const kernel::machine::Machine& machine);

/// Fills in the limiting depth, searched up to `most_depth_mm`, at the speed of each permitted step
/// of each programmed speed (rev/s, > 0). Refuses what limit_depth_mm refuses.
[[nodiscard]] kernel::outcome::Result<void> add_depths(const Process& process,
                                                       const std::vector<double>& programmed_rev_s,
                                                       double most_depth_mm,
                                                       online::SpeedTable::Config& config);

}  // namespace steadyrest::chatter::offline
