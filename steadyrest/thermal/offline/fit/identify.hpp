// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <functional>
#include <optional>
#include <string>
#include <vector>

#include <steadyrest/kernel/machine/thermal.hpp>
#include <steadyrest/kernel/outcome/result.hpp>
#include <steadyrest/thermal/offline/fit/structure_fit.hpp>

namespace steadyrest::thermal::offline {

struct AxisFit;

struct FitRequest {
  std::optional<std::size_t> modes;  ///< default: by left-out hours
  std::vector<std::string> sensors;  ///< temperatures that may be inputs; empty: all in the log
  bool ambient = true;               ///< temperatures may be inputs at all
  /// Levels as a table over the log's speeds, not as polynomials of the speed.
  bool table = false;
  double horizon_s = 4.0 * 3600.0;  ///< how far ahead the model must forecast
  double from_s = -1e300;           ///< of the log
  double to_s = 1e300;
  /// Source of time constants, sensors and, as prior knowledge, levels and gains.
  const kernel::machine::ThermalAxis* known = nullptr;
  /// Keeps the structure of that fit, with its time constants; fits the rest.
  const AxisFit* like = nullptr;
};

/// A fitted displacement and its quality.
struct AxisFit {
  kernel::machine::ThermalAxis axis;
  std::string channel;
  double rms_um = 0.0;  ///< of the fitted readings' residuals
  /// Of left-out readings, running free and re-zeroed every hour; NaN: log too short.
  double left_out_um = 0.0;
  double left_out_probed_um = 0.0;
  double coverage = 0.0;  ///< of the 95 % band, likewise
  double coverage_probed = 0.0;
  /// Standard deviation of each mode's ln τ; the passport's is with all others fixed.
  std::vector<double> ln_tau_sd;
  double condition = 0.0;
  double horizon_sd_um = 0.0;  ///< of a forecast over the horizon, from the parameters alone
  std::size_t blocks = 0;
  double end_s = 0.0;
  Structure structure;
  ErrorModel error;
  double log_evidence = 0.0;
};

/// The thermal modes of one displacement in the log, judged by left-out blocks: the simplest of all
/// structures that forecast them as well as the best one, to within one standard error.
///
/// Refused: a spindle that never turns, and what the log cannot support: a horizon of more than
/// twice the longest run at one speed, and a forecast uncertain by more than a quarter of the
/// measured range. The refusal states how long the test must be. With `known` the windows may be
/// short.
[[nodiscard]] kernel::outcome::Result<AxisFit> identify(
    const Log& log, std::size_t channel, const std::string& name, const FitRequest& request,
    const std::function<void(double share)>& progress = {});

}  // namespace steadyrest::thermal::offline
