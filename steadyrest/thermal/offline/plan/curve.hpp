// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <vector>

#include <steadyrest/thermal/offline/plan/cyclogram.hpp>
#include <steadyrest/thermal/offline/plan/exponentials.hpp>
#include <steadyrest/thermal/online/thermal_model.hpp>

namespace steadyrest::thermal::offline {

/// The displacement over a cyclogram in closed form: a sum of exponentials for each transition
/// (Polyakov's analytic form, from any initial state).
struct Curve {
  struct Piece {
    double start_s = 0.0;
    double seconds = 0.0;
    Exponentials displacement_mm;  ///< over the time since `start_s`
  };
  std::vector<Piece> piece;  ///< one for each transition

  /// At a time of the cyclogram; beyond its ends the value at the end.
  [[nodiscard]] double at(double time_s) const noexcept;
  [[nodiscard]] double total_s() const noexcept;
  /// Largest |displacement|, and when.
  struct Extreme {
    double displacement_mm = 0.0;
    double time_s = 0.0;
  };
  [[nodiscard]] Extreme largest() const;
};

/// From the model's present state on. The effect of the surroundings stays constant, except for
/// what still lags behind `ambient_c` (in the model's order; empty: each lagged temperature has
/// settled).
[[nodiscard]] Curve curve_of(online::ThermalModel model, const Cyclogram& cyclogram,
                             const std::vector<double>& ambient_c = {});

}  // namespace steadyrest::thermal::offline
