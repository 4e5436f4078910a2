// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
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

/// Whether any segment does.
[[nodiscard]] inline bool moves(kernel::signal::PathView path, std::size_t axis) noexcept {
  return std::ranges::any_of(
      path, [axis](const kernel::signal::PathSegment& segment) { return moves(segment, axis); });
}

}  // namespace steadyrest::math::geometry
