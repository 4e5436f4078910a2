// SPDX-License-Identifier: Apache-2.0
#include <steadyrest/contour/offline/learn/sharp_corners.hpp>
#include <steadyrest/math/geometry/segment.hpp>
#include <steadyrest/math/geometry/vector.hpp>

namespace steadyrest::contour::offline {
namespace {

constexpr double kSharpJoint = 0.3;

}  // namespace

SharpCorners sharp_corners(kernel::signal::PathView path) {
  std::vector<double> at_mm;
  for (std::size_t i = 0; i < path.size(); ++i) {
    const bool first = i == 0;
    const bool other = !first && path[i].motion != path[i - 1].motion;
    const bool bends =
        !first &&
        math::geometry::distance(math::geometry::station_at(path[i - 1], 1.0).tangent,
                                 math::geometry::station_at(path[i], 0.0).tangent) > kSharpJoint;
    if (first || other || bends) {
      at_mm.push_back(path[i].position_mm);
    }
  }
  if (!path.empty()) {
    at_mm.push_back(path.back().position_mm + path.back().length_mm);
  }
  return SharpCorners(std::move(at_mm));
}

}  // namespace steadyrest::contour::offline
