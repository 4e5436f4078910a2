// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <cmath>

#include <steadyrest/chatter/online/modulator.hpp>

namespace steadyrest::chatter::online {

/// Every value is within the range given in Modulation.
[[nodiscard]] inline bool fit(const Modulation& m) noexcept {
  return static_cast<int>(m.law) <= static_cast<int>(Law::stop) && m.amplitude_ratio >= 0.0 &&
         m.amplitude_ratio <= 0.9 && m.amplitude_rev_s >= 0.0 && m.amplitude_rev_s <= 1e5 &&
         m.period_s >= 0.02 && m.period_s <= 600.0 && m.mean_ratio >= 0.1 && m.mean_ratio <= 2.0;
}

}  // namespace steadyrest::chatter::online
