// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <span>

#include <Eigen/Core>

/// The part of a displacement's readings that no model explains: a first-order process (drift) and
/// white noise. Successive readings are then not independent, so they must be whitened before least
/// squares.
namespace steadyrest::thermal::offline {

struct ErrorModel {
  double drift_um = 1.0;  ///< RMS of the process
  double tau_s = 4.0 * 3600.0;
  double noise_um = 0.1;  ///< RMS of a reading
};

/// Turns each column in place into its innovations over their standard deviation, by the Kalman
/// filter of the error model; its gains depend only on the times, so linear relations are kept. The
/// process is new at the first row and after each row listed in `fresh`. Rows must have no holes.
/// Returns Σ ln S, S the innovations' variance.
double whiten(const ErrorModel& model, std::span<const double> time_s,
              std::span<const std::size_t> fresh, Eigen::MatrixXd& columns);

/// RMS of the white noise, from the second differences of neighbouring readings: drift has none.
[[nodiscard]] double noise_of(std::span<const double> time_s, std::span<const double> reading);

}  // namespace steadyrest::thermal::offline
