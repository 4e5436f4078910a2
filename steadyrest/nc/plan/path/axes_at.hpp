// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <steadyrest/kernel/signal/path.hpp>

namespace steadyrest::nc::plan {

/// Position of all axes and its derivative by path length, in the machine's axis order.
struct PathPoint {
  kernel::signal::AxisValues position{};
  kernel::signal::AxisValues direction{};
};

/// The point of the segment at `distance_mm` from its start, clipped to the segment: X, Y, Z by
/// math/geometry/segment.hpp, the other axes in proportion. At the end it is end_mm to the last
/// bit.
[[nodiscard]] PathPoint axes_at(const kernel::signal::PathSegment& segment,
                                double distance_mm) noexcept;

}  // namespace steadyrest::nc::plan
