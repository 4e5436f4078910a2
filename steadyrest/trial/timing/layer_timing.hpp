// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <functional>

#include <steadyrest/kernel/machine/machine.hpp>
#include <steadyrest/kernel/outcome/result.hpp>
#include <steadyrest/trial/timing/quantiles.hpp>

namespace steadyrest::trial::timing {

/// The layer's share of a control cycle on this computer.
struct LayerTiming {
  double cycle_s = 0.0;  ///< from the machine file
  int rounds = 0;
  std::size_t cycles = 0;     ///< of one round
  std::size_t decisions = 0;  ///< cycles among them in which the feed governor chose a step
  Quantiles work_s;           ///< the whole layer, all cycles
  Quantiles decision_s;       ///< the whole layer, the cycles with a decision
};

struct Effort {
  std::size_t decisions = 2000;  ///< p99.9 leaves out the two longest
  int rounds = 5;
};

/// Cuts `demanding_path` on the simulated machine of this file with the whole layer acting, and
/// times each cycle of the layer by the steady clock.
///
/// All rounds are identical to the last bit, so each cycle counts with its shortest time: a busy
/// computer can only add to it. The rest is the layer's own work with warm caches; listening for
/// chatter is not included.
///
/// `on_progress` gets the share done. Refused: what simulated machine or layer refuse.
[[nodiscard]] kernel::outcome::Result<LayerTiming> time_layer(
    const kernel::machine::Machine& machine, const Effort& effort,
    const std::function<void(double share)>& on_progress);

}  // namespace steadyrest::trial::timing
