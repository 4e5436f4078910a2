// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <span>

#include <steadyrest/nc/interpret/state/move.hpp>

namespace steadyrest::nc::interpret {

/// Number of knot spans of a clamped uniform B-spline: points − order + 1.
[[nodiscard]] int spline_spans(std::span<const SplinePoint> points, int order) noexcept;

/// The curve at u in 0 … spline_spans(), by de Boor's recursion in homogeneous coordinates. The
/// knots are `order` zeros, 1, 2, …, `order` times the number of spans, as in LinuxCNC. `points`
/// has at least `order` (2 … 8) points with positive weights.
[[nodiscard]] SplinePoint spline_at(std::span<const SplinePoint> points, int order,
                                    double u) noexcept;

}  // namespace steadyrest::nc::interpret
