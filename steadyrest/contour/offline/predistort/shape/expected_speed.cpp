// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <cmath>
#include <cstddef>

#include <steadyrest/contour/offline/predistort/shape/expected_speed.hpp>
#include <steadyrest/math/geometry/path_pairing.hpp>

namespace steadyrest::contour::offline {

CommandSpeed expected_speed(const nc::plan::PlannedPath& path, CommandSpeed planned, double lag_s,
                            const std::function<double(double at_mm)>& most_mm_s) {
  for (std::size_t i = 0; i < planned.progress_mm.size(); ++i) {
    const double at_mm = planned.progress_mm[i];
    const double v = std::min(planned.speed_mm_s[i], most_mm_s(at_mm));
    const auto& tool =
        path.segments[math::geometry::segment_at(path.segments, std::max(0.0, at_mm - v * lag_s))];
    const bool turns = tool.geometry == kernel::signal::Geometry::arc && tool.radius_mm > 0.0;
    planned.speed_mm_s[i] = turns ? v * std::hypot(1.0, v * lag_s / tool.radius_mm) : v;
  }
  return planned;
}

}  // namespace steadyrest::contour::offline
