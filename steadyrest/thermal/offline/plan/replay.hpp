// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <vector>

#include <steadyrest/kernel/machine/thermal.hpp>
#include <steadyrest/kernel/outcome/result.hpp>
#include <steadyrest/thermal/offline/log/log.hpp>

namespace steadyrest::thermal::offline {

/// How a passport is compared with a log.
struct ReplayRequest {
  std::optional<std::size_t> channel;  ///< the log's displacement for this axis
  double state_s = 0.0;                ///< time of the passport's states
  /// Start of the forecast; by default `state_s`, or the log's beginning if `state_s` is outside
  /// the log. Earlier readings set what the model does not know.
  std::optional<double> from_s;
  double rezero_s = 0.0;  ///< the forecast also uses a reading this often; 0 = none
};

struct ReplayPoint {
  double time_s = 0.0;
  double displacement_mm = 0.0;
  double sd_mm = 0.0;
  double measured_mm = 0.0;  ///< NaN where the log has none
  bool forecast = false;     ///< in the future, with no reading taken here
};

/// The displacement at each row of the log from its recorded inputs (speed, temperatures), with the
/// unknown part as a first-order process set by readings. Refused: a log without the passport's
/// sensors, or one that runs over a fifth faster than the fitted speed.
[[nodiscard]] kernel::outcome::Result<std::vector<ReplayPoint>> replay(
    const kernel::machine::ThermalAxis& axis, const Log& log, const ReplayRequest& request);

/// The quality of a forecast where readings exist.
struct ReplayScore {
  std::size_t points = 0;
  double rms_mm = 0.0;
  double coverage = 0.0;  ///< of the 95 % band
};
[[nodiscard]] ReplayScore score(const std::vector<ReplayPoint>& points, double noise_mm);

}  // namespace steadyrest::thermal::offline
