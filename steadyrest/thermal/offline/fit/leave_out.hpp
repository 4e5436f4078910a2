// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vector>

#include <Eigen/Core>

#include <steadyrest/thermal/offline/fit/structure_fit.hpp>

/// How well a structure forecasts hours it was not fitted to: each block of the log is left out in
/// turn.
namespace steadyrest::thermal::offline {

inline constexpr double kProbeEvery_s = 3600.0;

struct LeftOut {
  /// RMS of each block, with the model running free and with a reading every hour.
  std::vector<double> free_um;
  std::vector<double> probed_um;
  /// Over the blocks within reach: no forecast is made for the others.
  double free_rms_um = 0.0;
  double probed_rms_um = 0.0;
  /// For each block ½ ln(free·probed): both uses count alike.
  std::vector<double> loss;
  double mean_loss = 0.0;
  /// Reading less forecast, for each row of the data inside a block; else NaN. The first block
  /// starts cold and counts from its first reading: no other hour reveals the log's zero.
  Eigen::VectorXd residual_um;
};

/// Smaller errors make no difference.
inline constexpr double kGoodEnough_um = 0.2;

[[nodiscard]] LeftOut leave_out(const Structure& structure, const FitData& data,
                                const ErrorModel& error, const LinearPrior& prior);

/// For rows of one block: the residual less its value at the last probe reading.
[[nodiscard]] Eigen::VectorXd probed(const FitData& data, const FitData::Block& block,
                                     const Eigen::VectorXd& residual_um);

[[nodiscard]] double block_loss(double free_ms_um2, double probed_ms_um2);

/// The mean of a's loss exceeds b's by no more than one standard error of their difference and 10 %
/// of the error, or by 3 % of it. With few blocks, one of them hard, the standard error alone would
/// accept forecasts three times worse.
[[nodiscard]] bool as_good(const LeftOut& a, const LeftOut& b);

}  // namespace steadyrest::thermal::offline
