// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cmath>
#include <cstddef>

#include <steadyrest/kernel/signal/path.hpp>

namespace steadyrest::math::geometry {

/// Whether the segment moves this axis of X, Y, Z.
[[nodiscard]] inline bool moves(const kernel::signal::PathSegment& segment,
                                std::size_t axis) noexcept {
  constexpr double kSquare = 1.0 - 1e-9;  // to the plane of an arc: it does not move the axis
  return segment.start_mm[axis] != segment.end_mm[axis] ||
         (segment.geometry == kernel::signal::Geometry::arc &&
          std::abs(segment.axis[axis]) < kSquare);
}

}  // namespace steadyrest::math::geometry
