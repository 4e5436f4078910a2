// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vector>

#include <steadyrest/kernel/machine/thermal.hpp>
#include <steadyrest/thermal/offline/fit/structure_fit.hpp>

/// Between a passport and a structure with its linear parameters.
namespace steadyrest::thermal::offline {

/// The passport of a fit, with the states that the modes have come to at its last row. The constant
/// of the fit goes into the reference temperatures, shared so that they move least.
[[nodiscard]] kernel::machine::ThermalAxis fitted_axis(const Structure& structure,
                                                       const FitData& data, const LinearFit& fit,
                                                       const std::vector<double>& ln_tau_sd);

/// What a passport is made of (with tables: at the speeds of all of them, 0 at 0 rpm); the log has
/// all of its sensors.
[[nodiscard]] Structure structure_of(const kernel::machine::ThermalAxis& axis, const Log& log);

/// Levels and gains of the passport as what is known: its covariance, and `unsure` of each besides.
void known_prior(const kernel::machine::ThermalAxis& axis, double unsure,
                 const Structure& structure, LinearPrior& prior);

/// Standard deviation by the parameters alone after so long at the fastest speed, from rest.
[[nodiscard]] double horizon_sd_um(const kernel::machine::ThermalAxis& axis, double horizon_s);

}  // namespace steadyrest::thermal::offline
