// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <Eigen/Core>

#include <steadyrest/thermal/offline/leave_out.hpp>

namespace steadyrest::thermal::offline {

/// The drift of a passport, by the errors on blocks that were left out and are within reach: 97 %
/// of them (there are few blocks, and it is to be 95 % of others) lie within 1.96 standard
/// deviations, the model running free (RMS) and set right every hour (time constant); the RMS times
/// √(1 + 1/n) for one more block than these n.
struct Band {
  double drift_um = 0.0;
  double tau_s = 0.0;
  /// Share of left-out readings within the band when it was made from the other blocks.
  double free_coverage = 0.0;
  double probed_coverage = 0.0;
};

/// `columns`: the answer to each parameter; `covariance` of the parameters.
[[nodiscard]] Band calibrate(const FitData& data, const LeftOut& left_out,
                             const Eigen::MatrixXd& columns, const Eigen::MatrixXd& covariance);

}  // namespace steadyrest::thermal::offline
