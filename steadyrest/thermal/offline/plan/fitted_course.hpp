// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <vector>

#include <steadyrest/kernel/machine/thermal.hpp>
#include <steadyrest/kernel/outcome/result.hpp>
#include <steadyrest/thermal/offline/log/log.hpp>

namespace steadyrest::thermal::offline {

/// A passport compared with the log that it was fitted to.
struct FittedPoint {
  double time_s = 0.0;
  double measured_mm = 0.0;  ///< NaN where the log has none
  double modelled_mm = 0.0;
  double sd_mm = 0.0;   ///< of a reading about the model: parameters, drift and noise
  bool fitted = false;  ///< inside the fit's window, up to `to_s`; later ones are a forecast
};

/// δ of the law at each row from `from_s` on, from the log's inputs only. A passport does not keep
/// the state that each mode began with (at `from_s` and after each gap): it is found again by least
/// squares over the rows up to `to_s`, with a prior of some 30 µm. Readings have no other use here.
/// Refused: a log without the passport's sensors, a window without readings.
[[nodiscard]] kernel::outcome::Result<std::vector<FittedPoint>> fitted_course(
    const kernel::machine::ThermalAxis& axis, const Log& log, std::size_t channel,
    double from_s = -1e300, double to_s = 1e300);

}  // namespace steadyrest::thermal::offline
