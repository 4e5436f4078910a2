// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>

#include <Eigen/Core>

#include <steadyrest/thermal/offline/fit/leave_out.hpp>

namespace steadyrest::thermal::offline {

/// The drift of a passport, from the errors on left-out blocks within reach: 95 % of them are
/// within 1.96 standard deviations with the model running free (RMS), and 97 % when re-zeroed every
/// hour (time constant). For n blocks the RMS is widened by student(n)·√(1 + 1/n), for one more
/// block. The growth within an hour is not widened, since each block shows it many times. If the
/// bands made without a block still hold less than 95 % of that block's readings, the RMS grows by
/// what they lack.
struct Band {
  double drift_um = 0.0;
  double tau_s = 0.0;
  /// Share of left-out readings inside the band made from the other blocks, before it was widened
  /// for that.
  double free_coverage = 0.0;
  double probed_coverage = 0.0;
};

/// Student's t for 95 % relative to the normal law's, n − 1 degrees of freedom: what n blocks
/// reveal about the spread of others. 1.62 for four blocks, 1.15 for ten.
[[nodiscard]] double student(std::size_t blocks);

/// `columns`: the response to each parameter; `covariance` of the parameters.
[[nodiscard]] Band calibrate(const FitData& data, const LeftOut& left_out,
                             const Eigen::MatrixXd& columns, const Eigen::MatrixXd& covariance);

}  // namespace steadyrest::thermal::offline
