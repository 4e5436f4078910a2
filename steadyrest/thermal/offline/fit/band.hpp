// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>

#include <Eigen/Core>

#include <steadyrest/thermal/offline/fit/leave_out.hpp>

namespace steadyrest::thermal::offline {

/// The drift of a passport, by the errors on blocks that were left out and are within reach: 95 %
/// of them lie within 1.96 standard deviations, the model running free (RMS), and 97 % set right
/// every hour (time constant). Of n blocks the RMS is widened by student(n)·√(1 + 1/n), for one
/// more; what it does within an hour, which each block shows many times, is not. Where the bands
/// that were made without a block do not hold 95 % of these blocks' readings all the same, the RMS
/// grows by what they lack.
struct Band {
  double drift_um = 0.0;
  double tau_s = 0.0;
  /// Share of left-out readings within the band when it was made from the other blocks, before it
  /// was widened for that.
  double free_coverage = 0.0;
  double probed_coverage = 0.0;
};

/// Student's t for 95 % over that of the normal law, n − 1 degrees of freedom: what n blocks tell
/// of the spread of others. 1.62 for four blocks, 1.15 for ten.
[[nodiscard]] double student(std::size_t blocks);

/// `columns`: the answer to each parameter; `covariance` of the parameters.
[[nodiscard]] Band calibrate(const FitData& data, const LeftOut& left_out,
                             const Eigen::MatrixXd& columns, const Eigen::MatrixXd& covariance);

}  // namespace steadyrest::thermal::offline
