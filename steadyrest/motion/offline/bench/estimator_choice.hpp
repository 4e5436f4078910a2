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

/// What is known about the axis and its recorder. An estimator takes what it can use.
struct EstimatorSetup {
  double count_mm = 0.001;
  double cycle_hz = 1000.0;
  double clock_s = 0.0;  ///< period of the time stamps, 0 = exact
  double max_speed_mm_s = online::kNoBound;
  double max_acceleration_mm_s2 = online::kNoBound;
  double max_jerk_mm_s3 = online::kNoBound;
  std::optional<double> line_error_mm;  ///< largest error of an encoder line; none: not known
  double lag_s = 0.0;                   ///< fixed lag permitted by the user
  bool has_edges = true;                ///< false: only ticks
};

/// The first name is the default.
[[nodiscard]] std::vector<std::string_view> estimator_names();

using EstimatorResult = kernel::outcome::Result<std::unique_ptr<online::Estimator>>;

/// Refused: an unknown name; limits, line error or lag out of range; a lag for an estimator without
/// one; only ticks for one that needs edges; a missing limit.
[[nodiscard]] EstimatorResult make_estimator(std::string_view name, const EstimatorSetup& setup);

}  // namespace steadyrest::motion::offline
