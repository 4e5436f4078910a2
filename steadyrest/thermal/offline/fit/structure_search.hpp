// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <functional>
#include <vector>

#include <steadyrest/thermal/offline/fit/leave_out.hpp>

namespace steadyrest::thermal::offline {

struct SearchLimits {
  std::size_t most_modes = 3;
  std::size_t most_ambients = 2;
  std::vector<std::size_t> sensor;  ///< the log's temperatures that may be inputs
};

/// Structures over grids of time constants, each judged by leave_out(): the best few of every kind
/// (number of modes, powers of the speed, number of ambient inputs). The columns of all grids are
/// whitened once; a candidate then costs a few sums over their products. `progress` gets the share
/// of the work done.
[[nodiscard]] std::vector<Structure> search(const FitData& data, const ErrorModel& error,
                                            const SearchLimits& limits,
                                            const std::function<void(double share)>& progress = {});

}  // namespace steadyrest::thermal::offline
