// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include <steadyrest/apps/cli/shared/log_options.hpp>
#include <steadyrest/apps/cli/thermal/thermal_options.hpp>
#include <steadyrest/apps/cli/thermal/thermal_parts.hpp>
#include <steadyrest/apps/cli/thermal/thermal_plan_file.hpp>
#include <steadyrest/kernel/machine/machine.hpp>
#include <steadyrest/kernel/outcome/result.hpp>
#include <steadyrest/thermal/offline/log/measured.hpp>

/// The inputs of `thermal adapt`: a plan, its machine and work, and the measured parts.
namespace steadyrest::apps::cli {

struct AdaptOptions {
  std::string plan;
  std::string measured;
  ThermalOptions thermal;  ///< if the plan does not name its machine and work
  std::string output;
  double tolerance_um = 0.0;
  double noise_um = 0.0;
  LogOptions format;
  std::string started;
};

struct ThermalLevel {
  std::uint32_t number = 0;
  double share = 1.0;
};

struct AdaptInputs {
  ThermalPlanFile plan;
  std::string machine;  ///< the file
  kernel::machine::Thermal passport;
  ThermalLevel level;              ///< of the plan
  std::optional<ThermalJob> work;  ///< empty if nothing names it
  std::vector<thermal::offline::Measured> rows;
  std::vector<PlacedPart> parts;  ///< they point into `rows`: move, do not copy

  AdaptInputs() = default;
  AdaptInputs(AdaptInputs&&) = default;
  AdaptInputs& operator=(AdaptInputs&&) = default;
  AdaptInputs(const AdaptInputs&) = delete;
  AdaptInputs& operator=(const AdaptInputs&) = delete;
  ~AdaptInputs() = default;
};

/// Refused: an unfit file, or a machine file or work that is not the plan's.
[[nodiscard]] kernel::outcome::Result<AdaptInputs> read_adapt_inputs(AdaptOptions options);

}  // namespace steadyrest::apps::cli
