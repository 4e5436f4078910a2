// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <functional>
#include <vector>

#include <steadyrest/thermal/offline/fit/leave_out.hpp>

namespace steadyrest::thermal::offline {

struct SearchLimits {
  std::size_t most_modes = 3;
  std::size_t most_ambients = 2;
  std::vector<std::size_t> sensor;  ///< of the log's temperatures, that may be inputs
};

/// Structures over grids of time constants, each judged by leave_out(): of every kind (number of
/// modes, powers of the speed, number of ambient inputs) the best few. The columns of all grids are
/// made white once; a candidate then costs some sums over their products.
/// `share` of the work that is done goes to `progress`.
[[nodiscard]] std::vector<Structure> search(const FitData& data, const ErrorModel& error,
                                            const SearchLimits& limits,
                                            const std::function<void(double share)>& progress = {});

}  // namespace steadyrest::thermal::offline
