// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <cmath>
#include <cstddef>

#include <steadyrest/chatter/online/modulator.hpp>
#include <steadyrest/kernel/machine/chatter.hpp>

namespace steadyrest::chatter::online {

/// From `least` to `most`, both included.
struct ModulationRange {
  double least;
  double most;
  [[nodiscard]] constexpr bool holds(double value) const noexcept {
    return value >= least && value <= most;
  }
};

inline constexpr ModulationRange kAmplitudeRatio{0.0, 0.9};
inline constexpr ModulationRange kAmplitude_rev_s{0.0, 1e5};
inline constexpr ModulationRange kPeriod_s{0.02, 600.0};
inline constexpr ModulationRange kMeanRatio{0.1, 2.0};

/// Every value is within the range given in Modulation.
[[nodiscard]] inline bool fit(const Modulation& m) noexcept {
  return static_cast<std::size_t>(m.law) < kernel::machine::kSpeedLawNames.size() &&
         kAmplitudeRatio.holds(m.amplitude_ratio) && kAmplitude_rev_s.holds(m.amplitude_rev_s) &&
         kPeriod_s.holds(m.period_s) && kMeanRatio.holds(m.mean_ratio);
}

}  // namespace steadyrest::chatter::online
