// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <vector>

#include <steadyrest/apps/cli/thermal/thermal_plan_file.hpp>
#include <steadyrest/thermal/offline/log/measured.hpp>
#include <steadyrest/thermal/offline/plan/cyclogram.hpp>

namespace steadyrest::apps::cli {

/// A measured part beside the plan.
struct PlacedPart {
  const thermal::offline::Measured* row = nullptr;
  std::size_t axis = 0;  ///< of the plan
  double time_s = 0.0;
  double tolerance_mm = 0.0;
};

/// Finds each row's place in the plan; they point into `rows`. Tolerances, first that is there: the
/// row's, `tolerance_mm`, the transition's in `work` (may be none), the plan's. Refused by line of
/// `file`: instants behind the plan's end, transitions and axes that it has not, no tolerance.
[[nodiscard]] kernel::outcome::Result<std::vector<PlacedPart>> place_parts(
    const ThermalPlanFile& plan, const std::vector<thermal::offline::Measured>& rows,
    const std::string& file, double tolerance_mm, const thermal::offline::Cyclogram* work);

}  // namespace steadyrest::apps::cli
