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
  std::optional<std::size_t> modes;  ///< without it by left-out hours
  std::vector<std::string> sensors;  ///< temperatures that may be inputs; empty: all of the log
  bool ambient = true;               ///< temperatures may be inputs at all
  /// Levels as a table over the speeds that the log has, not as polynomials of the speed.
  bool table = false;
  double horizon_s = 4.0 * 3600.0;  ///< so far ahead the model shall forecast
  double from_s = -1e300;           ///< of the log
  double to_s = 1e300;
  /// Time constants, sensors and, as what is known beforehand, levels and gains are taken from it.
  const kernel::machine::ThermalAxis* known = nullptr;
  /// The structure of that fit stands, with its time constants; the rest is fitted.
  const AxisFit* like = nullptr;
};

/// A fitted displacement and what it is worth.
struct AxisFit {
  kernel::machine::ThermalAxis axis;
  std::string channel;
  double rms_um = 0.0;  ///< of what the model leaves of the readings that it was fitted to
  /// Of readings that were left out, running free and set right every hour; NaN: too short for it.
  double left_out_um = 0.0;
  double left_out_probed_um = 0.0;
  double coverage = 0.0;  ///< of the 95 % band, likewise
  double coverage_probed = 0.0;
  /// Standard deviation of each mode's ln τ; the passport has that with all others held.
  std::vector<double> ln_tau_sd;
  double condition = 0.0;
  double horizon_sd_um = 0.0;  ///< of a forecast over the horizon, by the parameters alone
  std::size_t blocks = 0;
  double end_s = 0.0;
  Structure structure;
  ErrorModel error;
  double log_evidence = 0.0;
};

/// The thermal modes of one displacement of the log, by left-out blocks: of all structures that
/// forecast them as well as the best to within one standard error, the simplest.
///
/// Refused: a spindle that never turns, and what the log cannot carry: a horizon of more than twice
/// the longest run at one speed, and a forecast that would be uncertain by more than a quarter of
/// what was measured. It is said how long the test must be. With `known` the windows may be short.
[[nodiscard]] kernel::outcome::Result<AxisFit> identify(
    const Log& log, std::size_t channel, const std::string& name, const FitRequest& request,
    const std::function<void(double share)>& progress = {});

}  // namespace steadyrest::thermal::offline
