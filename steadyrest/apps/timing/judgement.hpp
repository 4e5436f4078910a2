// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vector>

#include <steadyrest/apps/timing/layer_timing.hpp>
#include <steadyrest/kernel/machine/consistency.hpp>
#include <steadyrest/kernel/machine/machine.hpp>

namespace steadyrest::apps::timing {

/// Share of a control cycle that the layer may take; port, control and operating system need the
/// rest.
inline constexpr double kMostShare = 0.5;

/// Does the layer's work fit into its cycle? By p99.9 of the cycles with a decision, of all cycles
/// where that is more: beyond the cycle an error, beyond `kMostShare` of it a warning, both of the
/// check `cycle_time`.
[[nodiscard]] std::vector<kernel::machine::Finding> judge(const LayerTiming& timing,
                                                          const kernel::machine::Machine& machine);

}  // namespace steadyrest::apps::timing
