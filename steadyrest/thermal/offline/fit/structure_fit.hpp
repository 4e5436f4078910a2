// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <optional>
#include <vector>

#include <Eigen/Core>

#include <steadyrest/thermal/offline/fit/error_model.hpp>
#include <steadyrest/thermal/offline/fit/structure.hpp>

/// Least squares for one structure: linear parameters by QR, time constants by variable projection,
/// whitened by the error model so that the covariances are meaningful.
namespace steadyrest::thermal::offline {

/// Prior knowledge of the linear parameters: root·(a − mean) has unit covariance.
struct LinearPrior {
  Eigen::VectorXd mean;
  Eigen::MatrixXd root;
};
/// The structure's own `usual`; the constant is free if there are inputs, else it covers the first
/// reading's error. Levels of a table form a random walk from speed to speed, from 0 at 0 rpm to
/// the same spread at the fastest: an untested one lies between its neighbours.
[[nodiscard]] LinearPrior wide_prior(const Structure& structure, const FitData& data);

/// The linear parameters and their uncertainties.
struct LinearFit {
  Eigen::VectorXd amplitude;   ///< one for each column of columns_of()
  Eigen::MatrixXd covariance;  ///< of them; µm², the error model taken as true
  Eigen::VectorXd white;       ///< whitened residuals, the prior's below
  double log_sum = 0.0;
  double log_det = 0.0;    ///< of the covariance
  double condition = 0.0;  ///< of the columns, scaled to one length, by Frobenius' norm
};

struct RowRange {
  std::size_t begin = 0;
  std::size_t end = 0;
};

/// Does not fit `left_out`; the columns are those of all rows.
[[nodiscard]] LinearFit fit_linear(const Eigen::MatrixXd& columns, const FitData& data,
                                   const ErrorModel& error, const LinearPrior& prior,
                                   std::optional<RowRange> left_out = std::nullopt);

/// ln of the readings' likelihood integrated over the prior, up to a constant of the rows.
[[nodiscard]] double log_evidence(const LinearFit& fit, const LinearPrior& prior);

/// Least-squares time constants, starting from the structure's; within their bounds and apart.
/// Zeros stay zero, and so do the lags of a dense structure.
struct Refined {
  Structure structure;
  std::vector<double> ln_tau_sd;  ///< in the order of modes, rests, ambients
  /// The same with all others fixed: right where each is treated as independent of the others.
  std::vector<double> ln_tau_alone_sd;
};
[[nodiscard]] Refined refine(Structure structure, const FitData& data, const ErrorModel& error,
                             const LinearPrior& prior);

/// The maximum-likelihood error model for the structure's residuals.
[[nodiscard]] ErrorModel likely_error(const Eigen::MatrixXd& columns, const FitData& data,
                                      const LinearPrior& prior);

/// −2 ln(likelihood) + parameters·ln(rows), up to a constant.
[[nodiscard]] double bayes_criterion(const LinearFit& fit, const Structure& structure,
                                     std::size_t rows);

}  // namespace steadyrest::thermal::offline
