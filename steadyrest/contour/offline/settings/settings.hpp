// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <vector>

#include <steadyrest/contour/offline/predict/error_figures.hpp>
#include <steadyrest/kernel/machine/machine.hpp>
#include <steadyrest/kernel/outcome/result.hpp>
#include <steadyrest/nc/plan/path/planned_path.hpp>

namespace steadyrest::contour::offline {

/// What a setting of the control, or how the program asks for its corners, leaves of the error.
struct Setting {
  std::string what;  ///< the control's parameter and its value, in the control's own words
  kernel::machine::Machine machine;  ///< with it
  double seconds = 0.0;
  ErrorFigures figures;
  /// RMS where the velocity loops lag by `unsure_lag_s` more than the machine file says: it does
  /// not say how much, and feed-forward depends on it. Without a lag: `figures` are all there is.
  double unsure_lag_s = 0.0;
  double unsure_rms_mm = 0.0;
};

/// The settings that would leave less than half of the RMS error of a program, the best first.
///
/// Tried on the servo model (run_model): velocity feed-forward of X, Y and Z, equal gains (the
/// lowest), both, and a higher gain where the lag of the velocity loops is known: k·τ at most 0.25,
/// where a step of the position loop does not overshoot yet. Feed-forward is outside of the loops
/// and takes nothing from their damping. Its weight is the one whose worst error is least over the
/// lags that are possible: that of the machine file, or 0 to 0.1/k where the file has none; a
/// weight of √(1 − 2kτ) cancels the error of a circle.
[[nodiscard]] kernel::outcome::Result<std::vector<Setting>> cheapest_settings(
    const kernel::machine::Machine& machine, const nc::plan::PlannedPath& path, double limit_mm);

}  // namespace steadyrest::contour::offline
