// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vector>

#include <Eigen/Core>

#include <steadyrest/thermal/offline/fit/structure_fit.hpp>

/// How well a structure forecasts hours that it was not fitted to: each block of the log is left
/// out in turn.
namespace steadyrest::thermal::offline {

inline constexpr double kProbeEvery_s = 3600.0;

struct LeftOut {
  /// RMS of each block, the model running free, and set right by a reading every hour.
  std::vector<double> free_um;
  std::vector<double> probed_um;
  /// Of the blocks within reach: no forecast is made for the others.
  double free_rms_um = 0.0;
  double probed_rms_um = 0.0;
  /// Of each block ½ ln(free·probed): both uses count alike.
  std::vector<double> loss;
  double mean_loss = 0.0;
  /// Reading less forecast, for each row of the data that a block holds; else NaN. The first block
  /// begins cold and counts from its first reading: where the log has its zero no other hour tells.
  Eigen::VectorXd residual_um;
};

/// Errors below that are as good as none.
inline constexpr double kGoodEnough_um = 0.2;

[[nodiscard]] LeftOut leave_out(const Structure& structure, const FitData& data,
                                const ErrorModel& error, const LinearPrior& prior);

/// Of rows of one block: the residual less what it was at the last reading of a probe.
[[nodiscard]] Eigen::VectorXd probed(const FitData& data, const FitData::Block& block,
                                     const Eigen::VectorXd& residual_um);

[[nodiscard]] double block_loss(double free_ms_um2, double probed_ms_um2);

/// The mean of a's loss is above b's by no more than one standard error of their difference and 10
/// % of the error, or by 3 % of it. Of a few blocks of which one is hard the standard error alone
/// would let pass what forecasts three times worse.
[[nodiscard]] bool as_good(const LeftOut& a, const LeftOut& b);

}  // namespace steadyrest::thermal::offline
