// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vector>

#include <steadyrest/nc/plan/test/moves.hpp>

/// What a run of the interpolator took.
namespace steadyrest::nc::plan::test {

inline constexpr double kPeriod_s = 0.001;

inline double seconds(const std::vector<Setpoint>& s) {
  return static_cast<double>(s.size()) * kPeriod_s;
}

}  // namespace steadyrest::nc::plan::test
