// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <cmath>
#include <cstddef>

#include <steadyrest/chatter/online/modulator.hpp>
#include <steadyrest/kernel/machine/speed_law.hpp>

namespace steadyrest::chatter::online {

/// Every value is within the range given in Modulation.
[[nodiscard]] inline bool fit(const Modulation& m) noexcept {
  return static_cast<std::size_t>(m.law) < kernel::machine::kSpeedLawNames.size() &&
         m.amplitude_ratio >= 0.0 && m.amplitude_ratio <= 0.9 && m.amplitude_rev_s >= 0.0 &&
         m.amplitude_rev_s <= 1e5 && m.period_s >= 0.02 && m.period_s <= 600.0 &&
         m.mean_ratio >= 0.1 && m.mean_ratio <= 2.0;
}

}  // namespace steadyrest::chatter::online
