// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <string>
#include <vector>

#include <steadyrest/kernel/outcome/result.hpp>
#include <steadyrest/nc/rewrite/text/plan_file.hpp>

namespace steadyrest::apps::cli {

/// PLAN.json with the notes of `thermal plan` about its making. Paths are ready to be opened.
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
  double tolerance_um = 0.0;           ///< 0: not in the plan
  std::vector<Transition> transition;  ///< of its first axis
};

/// Refused: what nc::rewrite::read_plan() refuses, and notes of another type.
[[nodiscard]] kernel::outcome::Result<ThermalPlanFile> read_thermal_plan(const std::string& path);

/// The files named by a plan; none if it cannot be read.
[[nodiscard]] std::vector<std::string> files_of(const std::string& plan);

/// The correction in force in an axis from `time_s` on.
[[nodiscard]] double corrected_um(const nc::rewrite::AxisPlan& axis, double time_s);

}  // namespace steadyrest::apps::cli
