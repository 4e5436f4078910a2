// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <string>
#include <vector>

#include <steadyrest/kernel/outcome/result.hpp>
#include <steadyrest/nc/rewrite/text/plan_file.hpp>

namespace steadyrest::apps::cli {

/// PLAN.json with what `thermal plan` wrote about its making. Paths stand as they can be opened.
struct ThermalPlanFile {
  struct Transition {
    std::string name;
    double end_s = 0.0;
  };
  nc::rewrite::Plan plan;
  std::string machine;
  std::string cyclogram;
  std::string program;
  std::optional<double> level;
  std::optional<double> share;
  double tolerance_um = 0.0;           ///< 0: the plan does not say
  std::vector<Transition> transition;  ///< of its first axis
};

/// Refused: what nc::rewrite::read_plan() refuses, and notes of another type.
[[nodiscard]] kernel::outcome::Result<ThermalPlanFile> read_thermal_plan(const std::string& path);

/// The files that a plan names; none where it cannot be read.
[[nodiscard]] std::vector<std::string> files_of(const std::string& plan);

/// What stands corrected in an axis from `time_s` on.
[[nodiscard]] double corrected_um(const nc::rewrite::AxisPlan& axis, double time_s);

}  // namespace steadyrest::apps::cli
