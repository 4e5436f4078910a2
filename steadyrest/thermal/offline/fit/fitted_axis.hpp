// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vector>

#include <steadyrest/kernel/machine/thermal.hpp>
#include <steadyrest/thermal/offline/fit/structure_fit.hpp>

/// Conversions between a passport and a structure with its linear parameters.
namespace steadyrest::thermal::offline {

/// The passport of a fit, with the states of the modes at its last row. The fit's constant goes
/// into the reference temperatures, distributed so that they move least.
[[nodiscard]] kernel::machine::ThermalAxis fitted_axis(const Structure& structure,
                                                       const FitData& data, const LinearFit& fit,
                                                       const std::vector<double>& ln_tau_sd);

/// The structure behind a passport (with tables: at the speeds of all of them, 0 at 0 rpm); the log
/// has all of its sensors.
[[nodiscard]] Structure structure_of(const kernel::machine::ThermalAxis& axis, const Log& log);

/// The passport's levels and gains as prior knowledge: its covariance, plus `unsure` of each.
void known_prior(const kernel::machine::ThermalAxis& axis, double unsure,
                 const Structure& structure, LinearPrior& prior);

/// Standard deviation from the parameters alone after this time at the fastest speed, from rest.
[[nodiscard]] double horizon_sd_um(const kernel::machine::ThermalAxis& axis, double horizon_s);

}  // namespace steadyrest::thermal::offline
