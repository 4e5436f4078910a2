// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <string>
#include <vector>

#include <steadyrest/apps/page/thermal/thermal_page.hpp>
#include <steadyrest/thermal/offline/log/log.hpp>
#include <steadyrest/thermal/offline/plan/fitted_course.hpp>

namespace steadyrest::apps::page {

/// A displacement of the log and the axis fitted to it.
struct FittedAxis {
  std::string axis;
  std::size_t channel = 0;
  std::vector<thermal::offline::FittedPoint> point;
};

/// The page of `thermal fit`: each displacement over each temperature of the log (the paper's
/// figure 1), with the model's result and the residual.
[[nodiscard]] Json fit_page(const Json& answer, const thermal::offline::Log& log,
                            const std::vector<FittedAxis>& axes);

/// The page of `thermal forecast --log`: measured values, forecast and residual. A point is
/// `fitted` here if readings up to it have set the state; the channel is not used.
[[nodiscard]] Json replay_page(const Json& answer, const thermal::offline::Log& log,
                               const std::vector<FittedAxis>& axes);

}  // namespace steadyrest::apps::page
