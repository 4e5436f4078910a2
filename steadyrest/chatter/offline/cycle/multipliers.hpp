// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <complex>
#include <functional>
#include <vector>

#include <steadyrest/chatter/offline/cycle/delay_cycle.hpp>

/// Characteristic multipliers of a cut.
///
/// The dominant multipliers come from Arnoldi's method on the map of one period. Slow modulation
/// lets a vibration grow by 10¹⁵ and die again within a period; a product of that range loses its
/// eigenvalues to rounding, so the map is then driven pass by pass with a basis re-orthonormalised
/// each time (discrete QR).
namespace steadyrest::chatter::offline {

/// ln of the value reported where a vibration grows beyond a double's range.
inline constexpr double kBeyondLog = 700.0;

struct Multipliers {
  /// Of the principal period, the largest first; at least one. From discrete QR: divided by the
  /// modulus of the first, which may be beyond a double's range.
  std::vector<std::complex<double>> value;
  std::vector<double> log_modulus;  ///< ln|μ| over the principal period
  Eigen::VectorXd vector;           ///< real part of the dominant solution at the period's start
  double residual = 0.0;            ///< of the dominant multiplier, relative
  std::size_t passes_done = 0;
};

/// Multipliers of the cycle at its present depth. `wanted` ≥ 1.
[[nodiscard]] Multipliers multipliers(DelayCycle& cycle, std::size_t wanted = 2,
                                      double tolerance = 1e-10);

/// Of any linear map, by Arnoldi's method.
[[nodiscard]] Multipliers multipliers_of(
    const std::function<void(Eigen::Ref<Eigen::VectorXd>)>& apply, Eigen::Index size,
    std::size_t wanted = 2, double tolerance = 1e-10);

}  // namespace steadyrest::chatter::offline
