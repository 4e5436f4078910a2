// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include <steadyrest/kernel/outcome/result.hpp>
#include <steadyrest/motion/online/estimator/estimator.hpp>

/// The estimators by name, for command line and benchmark.
namespace steadyrest::motion::offline {

/// What is known of the axis and its recorder. An estimator takes what it has a use for.
struct EstimatorSetup {
  double count_mm = 0.001;
  double cycle_hz = 1000.0;
  double clock_s = 0.0;  ///< period of the time stamps, 0 = exact
  double max_speed_mm_s = online::kNoBound;
  double max_acceleration_mm_s2 = online::kNoBound;
  double max_jerk_mm_s3 = online::kNoBound;
  std::optional<double> line_error_mm;  ///< largest error of a line of the encoder; none: not known
  double lag_s = 0.0;                   ///< fixed lag that the user permits
  bool has_edges = true;                ///< false: there are ticks alone
};

/// The first name is the default.
[[nodiscard]] std::vector<std::string_view> estimator_names();

using EstimatorResult = kernel::outcome::Result<std::unique_ptr<online::Estimator>>;

/// Refused: a name that is none, limits or line error or lag that are not numbers of a machine, a
/// lag for an estimator that has none, ticks alone for one that needs edges, a missing limit.
[[nodiscard]] EstimatorResult make_estimator(std::string_view name, const EstimatorSetup& setup);

}  // namespace steadyrest::motion::offline
