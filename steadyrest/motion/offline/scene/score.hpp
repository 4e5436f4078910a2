// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <vector>

#include <steadyrest/motion/offline/scene/scene.hpp>
#include <steadyrest/motion/online/estimator/estimator.hpp>

/// Runs an estimator over a record and compares with the truth.
namespace steadyrest::motion::offline {

/// Edges in order, each before the first tick that is not earlier.
[[nodiscard]] std::vector<online::Estimate> run(online::Estimator& estimator, const Record& record);

/// Only the ticks: what an estimator without time stamps sees.
[[nodiscard]] Record without_edges(Record record);

struct Score {
  std::size_t ticks = 0;
  double velocity_rms_mm_s = 0.0;
  double velocity_max_mm_s = 0.0;
  double acceleration_rms_mm_s2 = 0.0;
  double acceleration_max_mm_s2 = 0.0;
  double velocity_coverage = 0.0;  ///< share of ticks with |error| ≤ bound
  double acceleration_coverage = 0.0;
  double velocity_bound_mm_s = 0.0;  ///< RMS of the bound
  double acceleration_bound_mm_s2 = 0.0;
};

/// Compares estimate k with the truth `lag_s` before tick k (linear in between), from `from_s` on
/// and where the true speed is at least `min_speed_mm_s`.
[[nodiscard]] Score score(const std::vector<online::Estimate>& estimates, const Record& record,
                          double lag_s = 0.0, double from_s = 0.0, double min_speed_mm_s = 0.0);

}  // namespace steadyrest::motion::offline
