// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <limits>

#include <steadyrest/kernel/signal/path.hpp>

namespace steadyrest::nc::follow {

/// A place on the path, and how far a point is from it.
struct Nearest {
  double position_mm = 0.0;  ///< path length from the program's start
  double away_mm = std::numeric_limits<double>::infinity();  ///< a radian counts as ten millimetres
};

/// The place of a segment nearest to a point, between two distances from the segment's start; of
/// equally near ones the one next to `expected_mm`.
[[nodiscard]] Nearest nearest(const kernel::signal::PathSegment& segment,
                              const kernel::signal::AxisValues& point, double low_mm,
                              double high_mm, double expected_mm) noexcept;

}  // namespace steadyrest::nc::follow
