// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <utility>
#include <vector>

#include <steadyrest/thermal/offline/log/log.hpp>

namespace steadyrest::thermal::offline::test {

inline constexpr double kWholeLog_s = 1e300;

/// A row each `every_s` of (minutes, rpm); the gauge starts at 100 µm and reads 1 µm more with
/// each.
inline Log log_of_runs(const std::vector<std::pair<int, double>>& runs, double every_s = 60.0) {
  Log log;
  log.displacement.push_back({"z_um", {}});
  for (const auto& [minutes, rpm] : runs) {
    for (int i = 0; i < static_cast<int>(60.0 * minutes / every_s); ++i) {
      const auto row = static_cast<double>(log.rows());
      log.time_s.push_back(every_s * row);
      log.speed_rev_s.push_back(rpm / 60.0);
      log.displacement[0].value.push_back(1e-3 * (100.0 + row));
    }
  }
  return log;
}

}  // namespace steadyrest::thermal::offline::test
