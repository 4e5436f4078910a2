// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <vector>

#include <steadyrest/apps/cli/thermal/thermal_plan_file.hpp>
#include <steadyrest/thermal/offline/log/measured.hpp>
#include <steadyrest/thermal/offline/plan/cyclogram.hpp>

namespace steadyrest::apps::cli {

/// A measured part and its place in the plan.
struct PlacedPart {
  const thermal::offline::Measured* row = nullptr;
  std::size_t axis = 0;  ///< of the plan
  double time_s = 0.0;
  double tolerance_mm = 0.0;
};

/// Finds each row's place in the plan; the results point into `rows`. Tolerance, first one present:
/// the row's, `tolerance_mm`, the transition's in `work` (may be null), the plan's. Refused by line
/// of `file`: instants after the plan's end, transitions and axes that it lacks, no tolerance.
[[nodiscard]] kernel::outcome::Result<std::vector<PlacedPart>> place_parts(
    const ThermalPlanFile& plan, const std::vector<thermal::offline::Measured>& rows,
    const std::string& file, double tolerance_mm, const thermal::offline::Cyclogram* work);

}  // namespace steadyrest::apps::cli
