// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <vector>

#include <steadyrest/kernel/machine/thermal.hpp>
#include <steadyrest/kernel/outcome/result.hpp>
#include <steadyrest/thermal/offline/log/log.hpp>

namespace steadyrest::thermal::offline {

/// How a passport is set against a log.
struct ReplayRequest {
  std::optional<std::size_t> channel;  ///< displacement of the log that is the axis's
  double state_s = 0.0;                ///< time at which the passport has its states
  /// From there on it is a forecast; without it from `state_s`, or from the log's beginning where
  /// that lies elsewhere. Readings before it tell what the model does not know.
  std::optional<double> from_s;
  double rezero_s = 0.0;  ///< a reading each so often is used in the forecast too; 0 = none
};

struct ReplayPoint {
  double time_s = 0.0;
  double displacement_mm = 0.0;
  double sd_mm = 0.0;
  double measured_mm = 0.0;  ///< NaN where the log has none
  bool forecast = false;     ///< of the future, and no reading was taken here
};

/// The displacement at each row of the log from its recorded inputs (speed, temperatures), with
/// what the model does not know as a first-order process that readings set. Refused: a log without
/// the sensors of the passport, or faster than it was fitted by more than a fifth.
[[nodiscard]] kernel::outcome::Result<std::vector<ReplayPoint>> replay(
    const kernel::machine::ThermalAxis& axis, const Log& log, const ReplayRequest& request);

/// What a forecast was worth where it was measured.
struct ReplayScore {
  std::size_t points = 0;
  double rms_mm = 0.0;
  double coverage = 0.0;  ///< of the 95 % band
};
[[nodiscard]] ReplayScore score(const std::vector<ReplayPoint>& points, double noise_mm);

}  // namespace steadyrest::thermal::offline
