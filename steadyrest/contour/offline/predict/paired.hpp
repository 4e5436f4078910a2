// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <steadyrest/contour/offline/predict/model_run.hpp>
#include <steadyrest/math/geometry/path_pairing.hpp>
#include <steadyrest/nc/plan/path/planned_path.hpp>

namespace steadyrest::contour::offline {

/// Of a changed path against its original.
[[nodiscard]] inline PathMap paired(const nc::plan::PlannedPath& changed,
                                    const math::geometry::PathPairing& pairing) {
  PathMap map;
  for (const kernel::signal::PathSegment& segment : changed.segments) {
    map.start_mm.push_back(pairing.original_mm(segment.position_mm));
    map.end_mm.push_back(pairing.original_mm(segment.position_mm + segment.length_mm));
  }
  return map;
}

}  // namespace steadyrest::contour::offline
