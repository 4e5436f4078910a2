// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <string>
#include <vector>

#include <steadyrest/apps/cli/shared/log_options.hpp>
#include <steadyrest/apps/cli/shared/session.hpp>

namespace steadyrest::apps::cli {

/// `thermal forecast --log`: a passport compared with recorded inputs.
struct ThermalReplayOptions {
  std::string machine;
  std::string log;
  LogOptions format;
  std::string output;
  std::string report;                 ///< folder of the page; empty: none
  std::vector<std::string> axes;      ///< empty: all of the passport
  std::vector<std::string> channels;  ///< NAME=AXIS, for a column not named like its axis
  std::optional<double> from_min;
  double rezero_min = 0.0;
  double step_s = 60.0;  ///< from row to row of the output
};

[[nodiscard]] Outcome replay_thermal_log(const ThermalReplayOptions& options);

}  // namespace steadyrest::apps::cli
