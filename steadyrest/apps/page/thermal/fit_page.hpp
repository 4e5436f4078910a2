// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <string>
#include <vector>

#include <steadyrest/apps/page/thermal/thermal_page.hpp>
#include <steadyrest/thermal/offline/log/log.hpp>
#include <steadyrest/thermal/offline/plan/fitted_course.hpp>

namespace steadyrest::apps::page {

/// A displacement of the log and the axis that was fitted to it.
struct FittedAxis {
  std::string axis;
  std::size_t channel = 0;
  std::vector<thermal::offline::FittedPoint> point;
};

/// The page of `thermal fit`: each displacement over each temperature of the log (the paper's
/// figure 1), beside what the model makes of it, and what is left.
[[nodiscard]] Json fit_page(const Json& answer, const thermal::offline::Log& log,
                            const std::vector<FittedAxis>& axes);

/// The page of `thermal forecast --log`: measured beside forecast, and what is left. A point is
/// `fitted` here where readings up to it have set the state; the channel is not used.
[[nodiscard]] Json replay_page(const Json& answer, const thermal::offline::Log& log,
                               const std::vector<FittedAxis>& axes);

}  // namespace steadyrest::apps::page
