// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <optional>
#include <vector>

#include <Eigen/Core>

#include <steadyrest/thermal/offline/fit/error_model.hpp>
#include <steadyrest/thermal/offline/fit/structure.hpp>

/// Least squares of one structure: linear parameters by QR, time constants by variable projection,
/// made white by the error model, so that covariances mean what they say.
namespace steadyrest::thermal::offline {

/// What is known of the linear parameters beforehand: root·(a − mean) has unit covariance.
struct LinearPrior {
  Eigen::VectorXd mean;
  Eigen::MatrixXd root;
};
/// The structure's own `usual`; the constant is free where there are inputs,
/// else what the first reading may be off. Levels of a table go from speed to speed as a
/// random walk from 0 at 0 rpm, to the same at the fastest: one that was not tested lies between
/// its neighbours.
[[nodiscard]] LinearPrior wide_prior(const Structure& structure, const FitData& data);

/// The linear parameters and what goes with them.
struct LinearFit {
  Eigen::VectorXd amplitude;   ///< one for each column of columns_of()
  Eigen::MatrixXd covariance;  ///< of them; µm², the error model taken as true
  Eigen::VectorXd white;       ///< residuals made white, those of the prior below
  double log_sum = 0.0;
  double log_det = 0.0;    ///< of the covariance
  double condition = 0.0;  ///< of the columns, scaled to one length, by Frobenius' norm
};

struct RowRange {
  std::size_t begin = 0;
  std::size_t end = 0;
};

/// `left_out` is not fitted; the columns are those of all rows.
[[nodiscard]] LinearFit fit_linear(const Eigen::MatrixXd& columns, const FitData& data,
                                   const ErrorModel& error, const LinearPrior& prior,
                                   std::optional<RowRange> left_out = std::nullopt);

/// ln of the likelihood of the readings over the prior, to a constant of the rows.
[[nodiscard]] double log_evidence(const LinearFit& fit, const LinearPrior& prior);

/// Time constants of least squares, from those of the structure on; within their bounds and apart.
/// Those that are 0 stay so, and so do the lags of a dense structure.
struct Refined {
  Structure structure;
  std::vector<double> ln_tau_sd;  ///< in the order of modes, rests, ambients
  /// The same with all others held: what counts where each is taken as independent of the others.
  std::vector<double> ln_tau_alone_sd;
};
[[nodiscard]] Refined refine(Structure structure, const FitData& data, const ErrorModel& error,
                             const LinearPrior& prior);

/// The error model of greatest likelihood for what the structure leaves.
[[nodiscard]] ErrorModel likely_error(const Eigen::MatrixXd& columns, const FitData& data,
                                      const LinearPrior& prior);

/// −2 ln(likelihood) + parameters·ln(rows), to a constant.
[[nodiscard]] double bayes_criterion(const LinearFit& fit, const Structure& structure,
                                     std::size_t rows);

}  // namespace steadyrest::thermal::offline
