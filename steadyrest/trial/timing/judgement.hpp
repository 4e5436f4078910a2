// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vector>

#include <steadyrest/kernel/machine/machine.hpp>
#include <steadyrest/passport/file/consistency.hpp>
#include <steadyrest/trial/timing/layer_timing.hpp>

namespace steadyrest::trial::timing {

/// Share of a control cycle that the layer may take; port, control and operating system need the
/// rest.
inline constexpr double kMostShare = 0.5;

/// Judges whether the layer's work fits into its cycle, by p99.9 of the cycles with a decision, or
/// of all cycles where that is more: beyond the cycle an error, beyond `kMostShare` of it a
/// warning, both for the check `cycle_time`.
[[nodiscard]] std::vector<passport::Finding> judge(const LayerTiming& timing,
                                                   const kernel::machine::Machine& machine);

}  // namespace steadyrest::trial::timing
